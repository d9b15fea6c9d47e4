// The parts of the panels: inputs for settings, problems, verdicts, numbers.

import {h} from "preact";
import {useLayoutEffect, useRef, useState} from "preact/hooks";
import {state, setting, unitOf} from "./store.js";
import {change, goTo} from "./actions.js";
import {fieldOf, fieldOfProblem, fieldText, partsOf} from "./fields.js";
import {fixed, isNumber, kStepTitles, kWaysOut, nameOf, plain, spoken, whole} from "./words.js";

let lastId = 0;

/** An id for an element, the same for as long as its component lives. */
function useId(stem) {
  return useState(() => `${stem}-${++lastId}`)[0];
}

/** For an input: its content is selected when it gets the focus, so that typing replaces it. */
export const kSelected = {
  onFocus: (event) => event.target.select(),
  onMouseDown: ({currentTarget}) => {
    if (document.activeElement === currentTarget) return;
    // The press that gives the focus would put the caret where it is, and so undo the selection.
    currentTarget.addEventListener("mouseup", (event) => event.preventDefault(), {once: true});
  },
};

/** A number with label and unit. It is handed on when the input is left, with Enter, or by the arrow keys.
 *  Emptied, it gives null if `isOptional`; `whenEmpty` is shown in it then. */
export function NumberInput({
  label,
  unit,
  value,
  step = "any",
  min,
  max,
  isOptional,
  problem,
  onChange,
  isShort,
  hint,
  whenEmpty,
}) {
  const id = useId("number"),
    [draft, setDraft] = useState(null);
  const commit = (event) => {
    const text = event.target.value.trim(),
      number = text === "" ? null : Number(text);
    setDraft(null);
    if (number === null ? isOptional : Number.isFinite(number)) onChange(number);
  };
  return h(
    "div",
    {class: isShort ? "number short" : "number"},
    h("label", {for: id}, label),
    h(
      "span",
      {class: "entry"},
      h("input", {
        id,
        type: "number",
        step,
        min,
        max,
        value: draft === null ? plain(value) : draft,
        placeholder: isOptional ? whenEmpty : undefined,
        "aria-invalid": problem ? "true" : undefined,
        "aria-describedby": `${id}-about`,
        ...kSelected,
        onInput: (event) => setDraft(event.target.value),
        onChange: commit,
      }),
      unit ? h("span", {class: "unit"}, unit) : null,
    ),
    h("span", {id: `${id}-about`, class: "about"}, hint, h(ProblemText, {problem})),
  );
}

/** Some text with a label. */
export function TextInput({label, value, onChange, problem}) {
  const id = useId("text"),
    [draft, setDraft] = useState(null);
  return h(
    "div",
    {class: "number"},
    h("label", {for: id}, label),
    h("input", {
      id,
      type: "text",
      value: draft === null ? value || "" : draft,
      spellcheck: false,
      "aria-invalid": problem ? "true" : undefined,
      "aria-describedby": `${id}-about`,
      onInput: (event) => setDraft(event.target.value),
      onChange: (event) => {
        setDraft(null);
        onChange(event.target.value.trim());
      },
    }),
    h("span", {id: `${id}-about`, class: "about"}, h(ProblemText, {problem})),
  );
}

/** A choice among [value, label]. */
export function Choice({label, value, options, onChange, problem}) {
  const id = useId("choice");
  return h(
    "div",
    {class: "number"},
    h("label", {for: id}, label),
    h(
      "select",
      {id, value, "aria-invalid": problem ? "true" : undefined, onChange: (event) => onChange(event.target.value)},
      options.map(([option, text]) => h("option", {key: option, value: option, selected: option === value}, text)),
    ),
    h("span", {class: "about"}, h(ProblemText, {problem})),
  );
}

/** A yes or no with its label. */
export function Check({label, isOn, onChange}) {
  return h(
    "label",
    {class: "check"},
    h("input", {type: "checkbox", checked: isOn, onChange: (event) => onChange(event.target.checked)}),
    h("span", null, label),
  );
}

/** A button; `isMain` for the one that goes on. */
export function Button({onClick, isMain, isPressed, disabled, title, children, ...rest}) {
  return h(
    "button",
    {
      type: "button",
      class: isMain ? "main" : undefined,
      disabled,
      title,
      "aria-pressed": isPressed === undefined ? undefined : String(isPressed),
      onClick,
      ...rest,
    },
    children,
  );
}

/** Numbers side by side: a point, a direction, a window. `names`: one label for each; `hintLines`: room for so many. */
export function Numbers({label, names, unit, value, step, onChange, problem, hint, hintLines}) {
  const id = useId("numbers"),
    [draft, setDraft] = useState(null); // until every number is there; none is made up
  const shown = draft || names.map((_, i) => (value && isNumber(value[i]) ? value[i] : null));
  const put = (k, number) => {
    const next = shown.map((old, i) => (i === k ? number : old));
    const isWhole = next.every(isNumber);
    setDraft(isWhole ? null : next);
    if (isWhole) onChange(next);
  };
  return h(
    "fieldset",
    {class: "numbers", "aria-describedby": id},
    h("legend", null, unit ? `${label}, ${unit}` : label),
    rowOf(
      names.map((name, k) =>
        h(NumberInput, {
          key: name,
          label: name,
          isShort: true,
          step,
          value: shown[k],
          problem: problem ? {} : null,
          onChange: (number) => put(k, number),
        }),
      ),
    ),
    h("span", {id, class: hintLines ? `about lines-${hintLines}` : "about"}, hint, h(ProblemText, {problem})),
  );
}

/** A vector's x, y and z; in mm unless another unit is given. */
export function VectorInput(about) {
  return h(Numbers, {unit: "mm", names: ["x", "y", "z"], step: 1, ...about});
}

/** A slider from 0 to `max`. @param said  its value in words   @param isUnseen  its label is for screen readers alone */
export function Slider({label, isUnseen, max, step, value, said, onInput}) {
  const id = useId("slider");
  return h(
    "div",
    {class: "slider"},
    h("label", {for: id, class: isUnseen ? "unseen" : undefined}, label),
    h("input", {
      id,
      type: "range",
      min: 0,
      max,
      step,
      value,
      "aria-valuetext": said,
      onInput: (event) => onInput(Number(event.target.value)),
    }),
  );
}

/** A row of buttons and what belongs to them. */
export function rowOf(...children) {
  return h("div", {class: "row"}, ...children);
}

/** A faint paragraph. */
export function softText(...children) {
  return h("p", {class: "soft"}, ...children);
}

// --- Settings of the case. ---

/** The problem of the last change or call that concerns a setting, or null. */
export function problemAt(key) {
  return Object.values(state.problems).find((problem) => problem && concerns(problem, key)) || null;
}

function concerns({path}, key) {
  return path && (path === key || path.startsWith(`${key}[`) || path.startsWith(`${key}.`));
}

// What the input shows: also a value that was refused, until another one is accepted.
function shownValue(key) {
  return key in state.refused && !(key in state.drafts) ? state.refused[key] : setting(key);
}

/** An input for any setting: number, words, yes or no, numbers in a row. Others are not shown. */
export function Setting({path, step, names, hint}) {
  const value = shownValue(path),
    unit = unitOf(path),
    problem = problemAt(path),
    field = fieldOf(path) || {label: nameOf(path)};
  const text = field.label,
    onChange = (next) => change({[path]: next});
  const about = {label: text, unit, problem, onChange, hint: hint || field.hint};
  if (names || isRow(value)) return h(Numbers, {...about, value, step, names: names || letters(value.length)});
  if (typeof value === "boolean") return h(Check, {label: text, isOn: value, onChange});
  const choices = state.case.choices && state.case.choices[path];
  const said = (word) => (field.words && field.words[word]) || spoken(word);
  if (choices) return h(Choice, {...about, value, options: choices.map((word) => [word, said(word)])});
  if (typeof value === "string") return h(TextInput, {...about, value, onChange: (words) => onChange(words || null)});
  if (value === null || isNumber(value))
    return h(NumberInput, {
      ...about,
      value,
      step,
      whenEmpty: field.whenEmpty,
      isOptional: Boolean(field.whenEmpty) || value === null,
    });
  return null;
}

/** Inputs for settings, side by side. @param hints  what is said of them, by their keys */
export function Settings({keys, hints = {}}) {
  return h(
    "div",
    {class: "grid"},
    keys.map((path) => h(Setting, {key: path, path, hint: hints[path]})),
  );
}

function isRow(value) {
  return Array.isArray(value) && value.length > 0 && value.every(isNumber);
}

function letters(count) {
  return ["x", "y", "z", "w"].slice(0, count);
}

// --- Problems. ---

/** What is wrong with an input's value, without the file and the key that the whole message names. */
export function complaint({found, expected, hint, message}) {
  if (!found || !expected) return message;
  return `Found ${found}; expected ${expected}.${hint ? ` ${hint}` : ""}`;
}

function ProblemText({problem}) {
  if (!problem || !problem.message) return null;
  return h("span", {class: "problem", role: "alert"}, h(Explained, {text: complaint(problem)}));
}

/** A message, with the page's own name beside each setting that it names by its key. */
export function Explained({text}) {
  return partsOf(text).map((part, k) => [
    part.text,
    part.field ? h("span", {key: k, class: "field-name"}, ` (${fieldText(part.field)})`) : null,
  ]);
}

/** Where something can be changed: a link to each of the steps but this one. */
export function StepLinks({steps}) {
  return steps
    .filter((step) => step !== state.step)
    .map((step) => [
      " ",
      h(
        "button",
        {key: step, type: "button", class: "step-link", "data-to": step, onClick: () => goTo(step)},
        `${kStepTitles[step]} →`,
      ),
    ]);
}

/** What went wrong in calls, unless it stands beside an input of this panel (`shown`: their keys). */
export function Problems({calls, shown = []}) {
  const isShown = (problem) => shown.some((key) => concerns(problem, key));
  const messages = calls.map((name) => (state.problems[name] ? state.problems[name].message : null)),
    isFirst = (problem, k) => messages.indexOf(problem.message) === k; // calls may end alike
  const found = calls
    .map((name) => [name, state.problems[name]])
    .filter(([, problem], k) => problem && !isShown(problem) && isFirst(problem, k));
  return found.map(([name, problem]) =>
    h(
      "div",
      {key: name, class: "problem block", role: "alert", "data-problem": name},
      problem.path && !problem.message.includes(problem.path)
        ? h("strong", null, h(Explained, {text: `${problem.path}: `}))
        : null,
      h(Explained, {text: problem.message}),
      problem.hint && !problem.message.includes(problem.hint) ? h("p", null, h(Explained, {text: problem.hint})) : null,
      h(WayOutOfProblem, {problem}),
      problem.kind === "crashed"
        ? h("p", null, "The calculation ended without an answer. The case is unharmed.")
        : null,
    ),
  );
}

function WayOutOfProblem({problem}) {
  const field = fieldOfProblem(problem);
  if (!field || field.step === state.step || (field.step !== "open" && !state.case)) return null;
  const text = `It can be changed as “${field.said || field.label}”:`;
  return h("p", {class: "way-out"}, text, h(StepLinks, {steps: [field.step]}));
}

// --- Verdicts. ---

const kStatus = {ok: ["✓", "Ok"], caution: ["!", "Caution"], refused: ["✕", "Refused"]};

/** A verdict's status in a word, with a sign. */
export function Status({status}) {
  const [sign, word] = kStatus[status] || ["?", spoken(status)];
  return h(
    "span",
    {class: `status ${status}`, "data-status": status},
    h("span", {class: "sign", "aria-hidden": "true"}, sign),
    word,
  );
}

/** A verdict's reasons, worst first, as the server orders them. One with a place is a button that goes there. */
export function Reasons({verdict, onPlace}) {
  const reasons = (verdict && verdict.reasons) || [];
  return h(
    "ul",
    {class: "reasons"},
    reasons.map((reason, k) =>
      h(
        "li",
        {key: k},
        h(Reason, {reason, onPlace}),
        (reasons[k + 1] || {}).id === reason.id ? null : h(WayOut, {id: reason.id}),
      ),
    ),
  );
}

/** What a person can do about a reason, and in which steps. */
export function WayOut({id}) {
  const [text, ...steps] = kWaysOut[id] || [];
  if (!text) return null;
  return h("p", {class: "way-out", "data-way-out": id}, text, h(StepLinks, {steps}));
}

function Reason({reason, onPlace}) {
  const at = reason.at || {},
    text = [
      h(Status, {status: reason.severity}),
      " ",
      h(Explained, {text: reason.message}),
      at.text ? h("span", {class: "soft"}, ` (${at.text})`) : null,
    ];
  if (!at.position_mm || !onPlace) return h("div", {class: "reason"}, text);
  return h(
    "button",
    {type: "button", class: "reason", title: "Show the place", onClick: () => onPlace(at.position_mm)},
    text,
    h(Target),
  );
}

function Target() {
  return h(
    "svg",
    {class: "go", viewBox: "0 0 16 16", "aria-hidden": "true"},
    h("circle", {cx: 8, cy: 8, r: 4.5, fill: "none", stroke: "currentColor", "stroke-width": 1.5}),
    h("path", {d: "M8 0v5M8 11v5M0 8h5M11 8h5", stroke: "currentColor", "stroke-width": 1.5}),
  );
}

// --- Numbers that were found. ---

/** Names and values. @param rows  [key, name, value]   @param keyName  the attribute that holds a row's key, if any */
export function FactList({rows, keyName}) {
  const marked = (key) => (keyName ? {[keyName]: key} : null);
  return h(
    "dl",
    {class: "facts"},
    rows.map(([key, name, value]) => [h("dt", {key}, name), h("dd", {key: `${key}-value`, ...marked(key)}, value)]),
  );
}

/** Whatever a summary holds, as names and values. */
export function Facts({facts}) {
  const shown = Object.entries(facts).filter(([, value]) => value !== null && typeof value !== "object");
  return h(FactList, {rows: shown.map(([key, value]) => [key, nameOf(key), factText(key, value)])});
}

/** A table of numbers. @param head  the columns' names  @param rows  [key, name, ...numbers]: as many numbers are shown
 *  as there are columns for  @param keyName  the attribute that holds a row's key */
export function DataTable({head: [first, ...columns], rows, keyName}) {
  return h(
    "table",
    {class: "numbers-table"},
    h(
      "thead",
      null,
      h(
        "tr",
        null,
        h("th", {scope: "col"}, first),
        columns.map((name) => h("th", {key: name, scope: "col", class: "number"}, name)),
      ),
    ),
    h(
      "tbody",
      null,
      rows.map(([key, name, ...numbers]) =>
        h(
          "tr",
          {key, [keyName]: key},
          h("th", {scope: "row"}, name),
          columns.map((column, k) => h("td", {key: column, class: "number"}, numbers[k])),
        ),
      ),
    ),
  );
}

const kUnits = {mm3: "mm³", mm2: "mm²", mm: "mm", hu: "HU", s: "s", kpa: "kPa"};

function factText(key, value) {
  if (!isNumber(value)) return typeof value === "boolean" ? (value ? "yes" : "no") : String(value);
  const unit = kUnits[key.split("_").pop()] || "";
  const number =
    Number.isInteger(value) || Math.abs(value) >= 1000 ? whole(value) : fixed(value, unit === "HU" ? 0 : 2);
  return unit ? `${number} ${unit}` : number;
}

/** A section of a panel with its heading, and beside that what goes on: nothing moves when it comes or goes.
 *  @param doing  [[call, text]], as of Working */
export function Section({title, children, id, doing = []}) {
  return h(
    "section",
    {"data-section": id},
    h(
      "div",
      {class: "section-head"},
      h("h3", null, title),
      doing.map(([call, text]) => h(Working, {key: call, call, text})),
    ),
    children,
  );
}

/** What comes and goes with answers. While one is on its way this part becomes no lower, so that what is below it
 *  stays where it is. */
export function Steady({isWaiting, children}) {
  const node = useRef(null),
    last = useRef(0);
  useLayoutEffect(() => {
    const {style} = node.current;
    style.minHeight = isWaiting ? `${last.current}px` : "";
    if (!isWaiting) last.current = node.current.getBoundingClientRect().height;
  });
  return h("div", {class: "steady", ref: node}, children);
}

/** Says whether a result is of what is set now, in one line either way. */
export function AsOf({isNow, now = "Result for the current settings.", past}) {
  const look = isNow ? "as-of soft" : "as-of warning";
  return h("p", {class: look, "data-as-of": isNow ? "now" : "past"}, isNow ? now : past);
}

/** What a call is doing, while it is: a bar where the share is known. In a row or a heading, where it moves nothing. */
export function Working({call, text}) {
  if (!state.busy[call]) return null;
  const progress = state.progress[call];
  return h(
    "p",
    {class: "working", role: "status", "data-busy": call},
    h("span", {class: "spinner", "aria-hidden": "true"}),
    progress && progress.stage ? spoken(progress.stage) : text,
    progress && isNumber(progress.fraction)
      ? h("progress", {max: 1, value: progress.fraction, "aria-label": text})
      : null,
  );
}

const [kLeastSize, kGreatestSize] = [20, 1000]; // mm: of a scan of a part of a body

/** A caution about lengths that no scan of a part of a body has. */
export function OddSize({sizes}) {
  const odd = sizes.find((size) => size < kLeastSize || size > kGreatestSize);
  if (odd === undefined) return null;
  return h(
    "p",
    {class: "warning", "data-odd": plain(odd)},
    `${plain(odd)} mm is ${odd < kLeastSize ? "little" : "much"} for a part of a body. Is the spacing right?`,
  );
}
