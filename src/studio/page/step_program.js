// Step 10: the gate, the robot's program, the arm that plays it, and what to save.

import {h} from "preact";
import {state, update} from "./store.js";
import {ask, goTo, playProgram, programOf, runAccepting} from "./actions.js";
import {NotRun, RunButton, isRunning} from "./step_run.js";
import {Button, Choice, FactList, Problems, Section, Working, rowOf} from "./widgets.js";
import {Commands} from "./commands.js";
import {Gate} from "./gate.js";
import {LaidGate} from "./laid_gate.js";
import {Withdrawn, isCurrent} from "./programs.js";
import {saveFile} from "./save_file.js";
import {duration, mm, spoken} from "./words.js";

// Of the programs that there can be: the arm's word, the result that holds it, its heading, its name in a list.
const kPrograms = [
  ["tissue", "lay", "Incision on the measured tissue", "the incision on the measured tissue"],
  ["mark", "mark", "Mark on the measured tissue", "the mark on the measured tissue"],
  ["run", "run", "Program of the run", "the program of the run"],
];

/** The panel. */
export function StepProgram() {
  const result = state.run;
  if (!result) return h("div", {"data-arm": "none"}, h(NotRun));
  const lines = commandsOf(state).filter(Boolean);
  return h(
    "div",
    {"data-arm": state.arm ? "there" : "none"},
    h(Programs, {result}),
    kPrograms.some(([, of]) => isCurrent(of)) ? h(Arm) : null,
    isCurrent("run") ? h(Save, {result}) : null,
    lines.length ? h(Section, {title: "Repeat", id: "repeat"}, h(Commands, {lines})) : null,
  );
}

// Of the run alone, or of it and what was laid, each with its own gate.
function Programs({result}) {
  if (!state.lay && !state.mark) return h(OneProgram, {of: "run", result, title: "Robot program"});
  return kPrograms
    .filter(([, of]) => state[of])
    .map(([word, of, title]) =>
      h(
        "div",
        {key: word, "data-program-of": word},
        h(OneProgram, {of, result, title, note: of === "run" ? h(Elsewhere) : null}),
      ),
    );
}

function OneProgram({of, result, title, note}) {
  const again = of === "run" ? h(RunButton, {text: "Run again"}) : null;
  if (!isCurrent(of)) return h(Section, {title, id: "gate"}, h(Withdrawn, {of}), again);
  return of === "run" ? h(RunGate, {result, title, note}) : h(LaidGate, {kind: of === "mark" ? of : "incise", title});
}

function Elsewhere() {
  return h(
    "p",
    {class: "warning", "data-laid-too": "yes"},
    "It cuts where the case says that the specimen lies, not where the camera found it. Running again removes what " +
      "was laid in step 9. ",
    h(Button, {onClick: () => goTo("register")}, "Go to step 9"),
  );
}

function RunGate({result, title, note}) {
  return h(Gate, {
    result,
    title,
    note,
    accepted: state.accept,
    onAccept: (accept) => update({accept}),
    onAgain: runAccepting,
    again: "Run again",
    aside: "nothing that was cut is cut again",
    call: "run",
    isBusy: isRunning(),
  });
}

function Arm() {
  const {arm} = state,
    there = kPrograms.filter(([word]) => programOf(word));
  return h(
    Section,
    {title: "Arm", id: "arm", doing: [["arm", "Playing the program"]]},
    there.length > 1
      ? h(Choice, {
          label: "It plays",
          value: state.armOf,
          options: there.map(([word, , , name]) => [word, name]),
          onChange: playProgram,
        })
      : there.map(([word, , , name]) => h("p", {key: word, class: "soft"}, `It plays ${name}.`)),
    h("div", {class: there.length ? "arm-facts" : null}, h(Problems, {calls: ["arm"]}), arm ? h(Played, {arm}) : null),
    there.length
      ? null
      : h("p", {class: "soft", "data-arm-reason": "yes"}, "Without a program the arm has nothing to play."),
  );
}

function Played({arm}) {
  return [
    h("p", {key: "outcome"}, `Outcome: ${spoken(arm.outcome).toLowerCase()}.`),
    arm.reason ? h("p", {key: "reason", class: "warning"}, arm.reason) : null,
    h(FactList, {
      key: "facts",
      rows: [
        ["duration", "Duration", duration(arm.duration_s)],
        ["deviation", "Greatest deviation of the tip", mm(arm.max_deviation_mm)],
      ],
    }),
    h("p", {key: "about", class: "soft"}, "A simulation of the arm and its controller. No robot moves."),
  ];
}

function Save({result}) {
  const save = async () => {
    const report = await ask("report");
    if (report) saveFile(report.name, report.html, "text/html");
  };
  return h(
    Section,
    {title: "Report", id: "report"},
    rowOf(
      h(Button, {disabled: Boolean(state.busy.report), onClick: save, "data-do": "save-report"}, "Save the report"),
      h(Working, {call: "report", text: "Reading the report"}),
    ),
    h(Problems, {calls: ["report"]}),
    result.report ? h("p", {class: "soft path"}, `It is kept as ${result.report}`) : null,
  );
}

// What gives the same results without the page, in the order in which it was done; none of what was withdrawn.
function commandsOf({run: result, photograph, frame, cloud, register, lay, mark}) {
  return [
    isCurrent("run") && result.command,
    photograph && photograph.command,
    ...((cloud.isOfFrame && frame && frame.commands) || []),
    isCurrent("register") && register.command,
    ...(isCurrent("mark") ? mark.commands : []),
    ...(isCurrent("lay") ? lay.commands : []),
  ];
}
