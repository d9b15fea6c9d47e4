// The gate before a robot's program: the cautions to accept, the checks, and the program itself.

import {h} from "preact";
import {Button, Check, Explained, Problems, Section, Status, WayOut} from "./widgets.js";
import {saveFile} from "./save_file.js";
import {fixed, isNumber, spoken} from "./words.js";

/** The section with the gate of a result, which holds `verdict`, `gate`, `checks`, `program`, `why_without_program`.
 *  All reasons of a caution stand beside its tick: who accepts it accepts each of them.
 *  @param accepted  ids that are ticked   @param onAccept  (ids)   @param onAgain  asks for the result with them
 *  @param again  what the button for that says of a result without any
 *  @param call      that gives the result   @param isBusy  whether it cannot be asked for now
 *  @param fileName  under which the program is saved   @param title  of the section   @param note  above all else
 *  @param aside     what else to say of the button once every caution is ticked */
export function Gate({result, accepted, onAccept, onAgain, again, call, isBusy, ...shown}) {
  const {fileName = "incise.script", title = "Robot program", note = null, aside = ""} = shown;
  const gate = result.gate || {};
  const open = cautionsOf(result, gate),
    button = accepted.length ? `${again} with these accepted` : again;
  const tick = (id, isOn) => onAccept(isOn ? [...accepted, id] : accepted.filter((other) => other !== id));
  return h(
    Section,
    {title, id: "gate"},
    note,
    h(Refused, {result, ids: gate.refused || []}),
    gate.open && !open.length ? h("p", null, "The gate is open: no caution has to be accepted.") : null,
    open.length
      ? h(
          "fieldset",
          {class: "gate"},
          h("legend", null, "Cautions that a person has to accept, each by itself"),
          open.map((id) =>
            h(Check, {
              key: id,
              label: h(ReasonsOf, {result, id}),
              isOn: accepted.includes(id),
              onChange: (isOn) => tick(id, isOn),
            }),
          ),
          h(Button, {disabled: isBusy || !isOther(accepted, gate), onClick: onAgain, "data-do": "accept"}, button),
        )
      : null,
    h(Problems, {calls: [call]}),
    result.program
      ? h(Program, {text: result.program, fileName})
      : h(
          "p",
          {class: "warning", "data-program": "none", role: "status"},
          h(Explained, {text: withoutProgram(result, {gate, accepted, isBusy, button, aside})}),
        ),
    result.checks && result.checks.length ? h(Checks, {checks: result.checks, isRefused: isRefused(gate)}) : null,
  );
}

function isRefused({refused = []}) {
  return refused.length > 0;
}

function withoutProgram({why_without_program: why}, {gate, accepted, isBusy, button, aside}) {
  const {missing = []} = gate,
    isWaiting = missing.length > 0 && !isRefused(gate);
  if (isWaiting && missing.every((id) => accepted.includes(id)))
    return isBusy ? "Writing the program…" : `Accepted. Press “${button}”${aside ? `: ${aside}` : ""}.`;
  if (why) return why;
  return isWaiting
    ? "There is no program yet: a person has to accept each of the cautions above."
    : "There is no program.";
}

function Refused({result, ids}) {
  if (!ids.length) return null;
  return h(
    "div",
    {"data-refused": ids.length},
    h("p", null, "The verdict refuses this cut. Nobody can accept it:"),
    ids.map((id) => [
      h("p", {key: id, class: "refusal"}, h(ReasonsOf, {result, id})),
      h(WayOut, {key: `${id}-out`, id}),
    ]),
  );
}

// In the order of the reasons: a caution that was accepted stays where it was.
function cautionsOf(result, gate) {
  const reasons = result.verdict.reasons || [];
  const place = (id) => reasons.findIndex((reason) => reason.id === id);
  return [...(gate.missing || []), ...(gate.accepted || [])].sort((a, b) => place(a) - place(b));
}

function isOther(accepted, gate) {
  return [...accepted].sort().join() !== [...(gate.accepted || [])].sort().join();
}

// All of them: a verdict may have several reasons of one id.
function ReasonsOf({result, id}) {
  const found = (result.verdict.reasons || []).filter((one) => one.id === id);
  if (!found.length) return spoken(id);
  if (found.length === 1) return h(ReasonText, {reason: found[0], before: `${spoken(id)}: `});
  return [
    `${spoken(id)}, ${found.length} reasons:`,
    found.map((reason, k) => h("span", {key: k, class: "one-reason"}, h(ReasonText, {reason}))),
  ];
}

function ReasonText({reason: {message, at}, before = ""}) {
  return [
    h(Explained, {key: "text", text: `${before}${message}`}),
    at && at.text ? h("span", {key: "at", class: "soft"}, ` (${at.text})`) : null,
  ];
}

function Checks({checks, isRefused: isCutRefused}) {
  const failed = checks.filter((check) => !check.passed).length;
  const passed = isCutRefused
    ? `All ${checks.length} checks of the motion passed; the cut is refused all the same`
    : `All ${checks.length} checks passed`;
  const title = failed ? `${failed} of ${checks.length} checks failed` : passed;
  return h(
    "details",
    {open: failed > 0},
    h("summary", null, title),
    h(
      "ul",
      {class: "facts"},
      checks.map((check, k) => h("li", {key: k}, h(OneCheck, {check}))),
    ),
  );
}

function OneCheck({check}) {
  const number = (value) => (isNumber(value) ? fixed(value, 2) : String(value));
  const has = Boolean(check.relation) && check.value !== null && check.value !== undefined;
  const found = has ? `: ${number(check.value)} ${check.unit || ""}` : "";
  return [h(Status, {status: check.passed ? "ok" : "refused"}), ` ${check.text}${found}`];
}

function Program({text, fileName}) {
  const save = () => saveFile(fileName, text, "text/plain");
  return h(
    "div",
    {"data-program": "there"},
    h(Button, {isMain: true, onClick: save, "data-do": "download"}, "Save the program"),
    h("pre", {tabIndex: 0, role: "region", "aria-label": "The robot's program"}, text),
  );
}
