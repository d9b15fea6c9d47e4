// How much margin fits round the edge that is drawn: asked for whenever the edge or the case is another.

import {state, isFresh, isSame, setting, when} from "./store.js";
import {refresh} from "./actions.js";

const kPause = 300; // ms after the last change: a point may be on its way

let timer = 0;

/** Asks whenever there is something new to ask about. @param edgeNow  gives the edge as it is known now */
export function watchRoom(edgeNow) {
  when(
    () => askedFor(edgeNow()),
    (asked) => {
      clearTimeout(timer);
      if (asked && !currentRoom(asked)) timer = setTimeout(askRoom, kPause, asked.points);
    },
  );
}

/** Whether an edge is one whose room is shown: closed, and drawn on the tissue at rest. */
export function hasRoom({points, isClosed, isRest}) {
  return isClosed && isRest && points.length > 2 && state.edge.where === "rest" && setting("plan.kind") !== "line";
}

// The edge with the case's revision; null while there is none, or the tissue is not known yet.
function askedFor(edge) {
  const isThere = isFresh("tissue") || (isFresh("body") && !state.busy.tissue);
  if (state.step !== "edge" || !isThere || Object.keys(state.drafts).length || !hasRoom(edge)) return null;
  return {points: edge.points, revision: state.case.revision};
}

function askRoom(points) {
  return refresh("room", {points_mm: points}, "room", {points, margin: setting("plan.lateral_margin_mm")});
}

/** The answer for an edge and the case as they are, or null. */
export function currentRoom({points}) {
  return isFresh("room") && isSame(state.room.points, points) ? state.room : null;
}

/** The ring's lines: {free, cut, isClosed}; `cut`: where it lies on a cut face; `isClosed`: `free` is the whole ring. */
export function partsOfRing({ring, on_cut_face: onCut}) {
  if (!onCut.includes(1)) return {free: [ring], cut: [], isClosed: true};
  const lines = {free: [], cut: [], isClosed: false};
  let last = null;
  ring.forEach((point, k) => {
    const next = (k + 1) % ring.length,
      name = onCut[k] || onCut[next] ? "cut" : "free";
    if (name !== last) lines[name].push([point]);
    lines[name].at(-1).push(ring[next]);
    last = name;
  });
  return lines;
}
