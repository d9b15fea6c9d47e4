// Step 10: the gate, the robot's program, the arm that plays it, and what to save.

import {h} from "preact";
import {state, update, isFresh} from "./store.js";
import {ask, goTo, playProgram, programOf, run, runAccepting} from "./actions.js";
import {isRunning} from "./step_run.js";
import {Button, Choice, Problems, Section, Working} from "./widgets.js";
import {Commands} from "./commands.js";
import {Gate} from "./gate.js";
import {saveFile} from "./save_file.js";
import {duration, mm, spoken} from "./words.js";

const kPrograms = [
  ["run", "of the run"],
  ["tissue", "laid on the measured tissue"],
];

/** The panel. */
export function StepProgram() {
  const result = state.run;
  if (!result)
    return h(
      "div",
      {"data-arm": "none"},
      h("p", {class: "soft"}, "This case has not been run in this session. A result in the cache comes at once."),
      h(Button, {isMain: true, disabled: isRunning(), onClick: run, "data-do": "run"}, "Run"),
      h(Problems, {calls: ["run"]}),
    );
  return h(
    "div",
    {"data-arm": state.arm ? "there" : "none"},
    isFresh("run") ? null : h("p", {class: "warning"}, "The settings have changed since this run."),
    programOf("tissue")
      ? h(
          "p",
          {class: "warning", "data-laid-too": "yes"},
          "This is the program of the run. The one on the measured tissue stands in step 9; running again removes it. ",
          h(Button, {onClick: () => goTo("register")}, "Go to it"),
        )
      : null,
    h(Gate, {
      result,
      accepted: state.accept,
      onAccept: (accept) => update({accept}),
      onAgain: runAccepting,
      again: "Run again with these accepted",
      call: "run",
      isBusy: isRunning(),
    }),
    h(Arm, {result}),
    h(Save, {result}),
    h(Section, {title: "Repeat", id: "repeat"}, h(Commands, {lines: commandsOf(state)})),
  );
}

function Arm({result}) {
  const {arm} = state;
  return h(
    Section,
    {title: "Arm", id: "arm"},
    programOf("tissue")
      ? h(Choice, {label: "Program", value: state.armOf, options: kPrograms, onChange: playProgram})
      : null,
    h(Working, {call: "arm", text: "Playing the program"}),
    h(Problems, {calls: ["arm"]}),
    arm
      ? [
          h("p", {key: "outcome"}, `Outcome: ${spoken(arm.outcome).toLowerCase()}.`),
          arm.reason ? h("p", {key: "reason", class: "warning"}, arm.reason) : null,
          h(
            "dl",
            {key: "facts", class: "facts"},
            h("dt", null, "Duration"),
            h("dd", null, duration(arm.duration_s)),
            h("dt", null, "Greatest deviation of the tip"),
            h("dd", null, mm(arm.max_deviation_mm)),
          ),
          h("p", {key: "about", class: "soft"}, "A simulation of the arm and its controller. No robot moves."),
        ]
      : null,
    result.program || programOf("tissue")
      ? null
      : h("p", {class: "soft", "data-arm-reason": "yes"}, "Without a program the arm has nothing to play."),
  );
}

function Save({result}) {
  const save = async () => {
    const report = await ask("report");
    if (report) saveFile(report.name, report.html, "text/html");
  };
  return h(
    Section,
    {title: "Report", id: "report"},
    h(Button, {disabled: Boolean(state.busy.report), onClick: save, "data-do": "save-report"}, "Save the report"),
    h(Working, {call: "report", text: "Reading the report"}),
    h(Problems, {calls: ["report"]}),
    result.report ? h("p", {class: "soft path"}, `It is kept as ${result.report}`) : null,
  );
}

// What gives the same results without the page, in the order in which it was done.
function commandsOf({run: result, photograph, register, lay}) {
  return [
    result.command,
    photograph && photograph.command,
    register && register.command,
    ...((lay && lay.commands) || []),
  ];
}
