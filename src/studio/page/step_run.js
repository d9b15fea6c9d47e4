// Step 6: run, and watch it.

import {h} from "preact";
import {useEffect, useRef, useState} from "preact/hooks";
import {state, isFresh} from "./store.js";
import {goTo, run, stop} from "./actions.js";
import {partsOfRun, shareOfPart, wordForPart} from "./run_parts.js";
import {Button, Explained, Problems, Section, rowOf, softText} from "./widgets.js";
import {duration, isNumber, place, spoken} from "./words.js";

const kQuiet = 5000; // ms between announcements

/** Whether a run is under way, ours or one that was started before this page was. */
export function isRunning() {
  return Boolean(state.busy.run) || state.running.some((job) => job.call === "run");
}

/** The panel. */
export function StepRun() {
  const isOn = isRunning();
  return h(
    "div",
    null,
    h(
      Section,
      {title: "Run", id: "run"},
      softText("The path is cut as planned in the simulation, corrected, and cut again."),
      rowOf(
        h(Button, {isMain: true, disabled: isOn, onClick: run, "data-do": "run"}, state.run ? "Run again" : "Run"),
        h(Button, {disabled: !isOn, onClick: () => stop("run"), "data-do": "stop"}, "Stop"),
      ),
      isOn ? h(Progress) : null,
      h(Problems, {calls: ["run"]}),
      h(Last, {isOn}),
      h(Moment),
    ),
    h(Messages),
  );
}

/** A button that runs the case, with what went wrong. */
export function RunButton({text}) {
  return [
    h(Button, {key: "run", isMain: true, disabled: isRunning(), onClick: run, "data-do": "run"}, text),
    h(Problems, {key: "problems", calls: ["run"]}),
  ];
}

/** Shown while there is no result. */
export function NotRun() {
  const text = "This case has not been run in this session. A result in the cache comes at once.";
  return [h("p", {key: "about", class: "soft"}, text), h(RunButton, {key: "run", text: "Run"})];
}

function progressOfRun() {
  return state.progress.run || state.running.find((job) => job.call === "run") || {};
}

function Progress() {
  const {stage, left_s: left} = progressOfRun(),
    share = shareOfPart(),
    now = partsOfRun().find(({is}) => is === "now");
  const text = [
    spoken(stage) || "Starting",
    stage && now ? now.name : "",
    share === undefined ? "" : `${Math.round(100 * share)} %`,
    isNumber(left) ? `about ${duration(left)} left in this ${wordForPart()}` : "",
  ]
    .filter(Boolean)
    .join(", ");
  return h(
    "div",
    {class: "progress", "data-progress": share === undefined ? "" : share.toFixed(3)},
    h(Parts),
    h("p", null, text),
    h("progress", {max: 1, value: share, "aria-label": `Progress of this ${wordForPart()}`}),
    h(Announcer, {text}),
  );
}

const kParts = {
  done: ["✓", "done"],
  now: ["▸", "under way"],
  ahead: ["·", "to come"],
  "left out": ["–", "not needed"],
};

/** Where the run is as a whole; the bar below it is about the part that is under way. */
function Parts() {
  return h(
    "ol",
    {class: "run-parts", "aria-label": "Parts of the run"},
    partsOfRun().map(({name, is}) =>
      h(
        "li",
        {key: name, "data-part": is, "aria-current": is === "now" ? "step" : undefined},
        h("span", {"aria-hidden": "true"}, kParts[is][0]),
        ` ${name}`,
        h("span", {class: "unseen"}, `, ${kParts[is][1]}`),
      ),
    ),
  );
}

/** Tells a screen reader what goes on, at most every few seconds. */
function Announcer({text}) {
  const [said, setSaid] = useState(""),
    last = useRef(0);
  useEffect(() => {
    const wait = Math.max(0, last.current + kQuiet - Date.now());
    const timer = setTimeout(() => {
      last.current = Date.now();
      setSaid(text);
    }, wait);
    return () => clearTimeout(timer);
  }, [text]);
  return h("span", {class: "unseen", "aria-live": "polite"}, said);
}

function Last({isOn}) {
  if (!state.run || isOn) return null;
  return h(
    "p",
    {class: isFresh("run") ? "notice" : "warning"},
    isFresh("run") ? "There is a result for these settings. " : "The settings have changed since the last run. ",
    h(Button, {onClick: () => goTo("compare")}, "Show the result"),
  );
}

function Moment() {
  const {moment} = state;
  if (!moment) return null;
  return h(
    "p",
    {"data-moment": moment.time_s},
    `${spoken(moment.cut)}: ${moment.time_s.toFixed(2)} s, tip at ${moment.tip.map(place).join(", ")} mm`,
    `, ${moment.removed_tets} tets removed`,
  );
}

const kSigns = {error: "✕", warning: "!", notice: "·", info: "·"};

// The newest first; one that came several times at its newest place, with their number.
function distinct(messages) {
  const found = new Map();
  for (const one of messages) {
    const key = `${one.severity} ${one.text}`,
      count = found.has(key) ? found.get(key).count + 1 : 1;
    found.delete(key);
    found.set(key, {...one, count});
  }
  return [...found.values()].reverse();
}

// Of runs alone: what the scan and the tissue have to say stands in their steps.
function Messages() {
  const list = distinct(state.messages.filter(({call}) => call === "run"));
  return h(
    Section,
    {title: "Messages", id: "messages"},
    list.length
      ? h(
          "ol",
          {class: "messages", tabIndex: 0, "aria-label": "Messages, the newest first"},
          list.map((one) =>
            h(
              "li",
              {key: one.key, "data-severity": one.severity},
              h("span", {class: "sign", "aria-hidden": "true"}, kSigns[one.severity] || "·"),
              h("span", {class: "soft"}, `${spoken(one.severity)}: `),
              h(Explained, {text: one.text}),
              one.count > 1 ? h("span", {class: "soft", "data-count": one.count}, ` (${one.count} times)`) : null,
            ),
          ),
        )
      : softText("None yet."),
  );
}
