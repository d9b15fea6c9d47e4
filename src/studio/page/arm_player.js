// The time of the arm that plays the program: play, pause, speed, and what the arm does at a moment.

import {h} from "preact";
import {useEffect, useReducer} from "preact/hooks";
import {state} from "./store.js";
import {Button, Slider, rowOf} from "./widgets.js";
import {fixed, place, spoken} from "./words.js";

const kSpeeds = [1, 5, 20];
const kSlowStep = 500; // ms between pictures where a person asked for little motion

/** The player. It is no part of the state: it changes with every picture, and only the arm and its bar follow it. */
export const player = {time: 0, speed: 1, isPlaying: false};

const listeners = new Set();
let last = 0,
  frame = 0;

/** Calls back whenever the player's time or speed changes. @returns what ends it */
export function onPlayer(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

function set(patch) {
  Object.assign(player, patch);
  for (const listener of listeners) listener();
}

function wantsLittleMotion() {
  return window.matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Starts, or starts again from the beginning at the end. */
export function play() {
  const {arm} = state;
  if (!arm) return;
  set({isPlaying: true, time: player.time >= arm.duration_s ? 0 : player.time});
  last = performance.now();
  cancelAnimationFrame(frame);
  frame = requestAnimationFrame(tick);
}

/** Stops where it is. */
export function pause() {
  set({isPlaying: false});
}

/** Goes to a time, s. */
export function seek(time) {
  set({time: Math.max(0, Math.min(time, state.arm ? state.arm.duration_s : 0))});
}

/** Back to the start. */
export function rewind() {
  set({time: 0, isPlaying: false});
}

function tick(now) {
  const {arm} = state;
  if (!player.isPlaying || !arm || state.step !== "program") return set({isPlaying: false});
  frame = requestAnimationFrame(tick);
  if (wantsLittleMotion() && now - last < kSlowStep) return undefined;
  const time = player.time + (player.speed * Math.max(0, now - last)) / 1000;
  last = now;
  return set(time < arm.duration_s ? {time} : {time: arm.duration_s, isPlaying: false});
}

// --- The arm at a moment. ---

/** {k, share}: the sample at or before a time, and the part of the way to the next. */
export function sampleAt({time_s: times}, time) {
  let low = 0,
    high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const span = times[high] - times[low];
  return {k: low, share: span > 0 ? Math.max(0, Math.min(1, (time - times[low]) / span)) : 0};
}

/** Both ends of each hull at a time: [[x, y, z, x, y, z]], mm. */
export function endsAt(arm, time) {
  const {k, share} = sampleAt(arm, time),
    width = 6 * arm.hulls.length,
    next = Math.min(k + 1, arm.time_s.length - 1);
  return arm.hulls.map((_, hull) =>
    Array.from({length: 6}, (__, c) => {
      const from = arm.ends[k * width + 6 * hull + c];
      return from + share * (arm.ends[next * width + 6 * hull + c] - from);
    }),
  );
}

function tipAt(arm, time) {
  const {k, share} = sampleAt(arm, time),
    next = Math.min(k + 1, arm.time_s.length - 1);
  const step = [0, 1, 2].map((c) => arm.tip[3 * next + c] - arm.tip[3 * k + c]);
  const span = arm.time_s[next] - arm.time_s[k];
  return {
    at: step.map((value, c) => arm.tip[3 * k + c] + share * value),
    speed: span > 0 ? Math.hypot(...step) / span : 0,
    phase: arm.phases[arm.phase[k]],
  };
}

/** The parts of the program: [{phase, from, to}], s. */
function partsOf({phase, phases, time_s: times, duration_s: end}) {
  const parts = [];
  phase.forEach((number, k) => {
    if (k && number === phase[k - 1]) return;
    if (parts.length) parts.at(-1).to = times[k];
    parts.push({phase: phases[number], from: times[k], to: end});
  });
  return parts;
}

// --- The bar below the picture. ---

/** Play, pause, speed, and the slider over time. */
export function Player() {
  const [, redraw] = useReducer((count) => count + 1, 0);
  useEffect(() => onPlayer(redraw), []);
  const {arm} = state;
  if (!arm) return null;
  const {at, speed, phase} = tipAt(arm, player.time);
  return h(
    "section",
    {
      class: "player",
      "aria-label": "Player",
      "data-playing": String(player.isPlaying),
      "data-time": player.time.toFixed(3),
    },
    rowOf(
      h(
        Button,
        {isMain: true, onClick: player.isPlaying ? pause : play, "data-do": "play"},
        player.isPlaying ? "Pause" : "Play",
      ),
      h(Button, {onClick: rewind, "data-do": "rewind"}, "To the start"),
      h(
        "span",
        {class: "row tight", role: "group", "aria-label": "Speed"},
        kSpeeds.map((factor) =>
          h(
            Button,
            {
              key: factor,
              isPressed: player.speed === factor,
              onClick: () => set({speed: factor}),
              "data-speed": factor,
            },
            `${factor}×`,
          ),
        ),
      ),
      h(
        "div",
        {class: "readings"},
        h("strong", {"data-phase": phase}, spoken(phase)),
        h("span", null, `${fixed(player.time, 1)} of ${fixed(arm.duration_s, 1)} s`),
        h("span", {"data-tip-speed": speed.toFixed(2)}, `tip at ${fixed(speed, 1)} mm/s`),
        h("span", {class: "soft"}, `${at.map(place).join(", ")} mm`),
      ),
    ),
    h(Time, {arm}),
    h(Parts, {arm}),
  );
}

function Time({arm}) {
  return h(Slider, {
    label: "Time, s",
    isUnseen: true,
    max: arm.duration_s,
    step: 0.05,
    value: player.time,
    said: `${fixed(player.time, 1)} s, ${spoken(tipAt(arm, player.time).phase)}`,
    onInput: seek,
  });
}

function Parts({arm}) {
  return h(
    "ol",
    {class: "parts", "aria-label": "Parts of the program"},
    partsOf(arm).map(({phase, from, to}) => {
      const isNow = player.time >= from && player.time < to;
      return h(
        "li",
        {key: from, style: {flexGrow: Math.max(0.01, to - from)}},
        h(
          "button",
          {
            type: "button",
            title: `${spoken(phase)}: ${fixed(from, 1)} to ${fixed(to, 1)} s`,
            "aria-current": isNow ? "true" : undefined,
            onClick: () => seek(from),
          },
          spoken(phase),
        ),
      );
    }),
  );
}
