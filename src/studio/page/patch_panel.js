// The panel's part for a painted patch in step Hold: radius, points, and a way to paint without a mouse.

import {h} from "preact";
import {useState} from "preact/hooks";
import {state} from "./store.js";
import {isAtRest, paintPatch, putPatch, togglePainting} from "./patch.js";
import {kMostPoints} from "./brush.js";
import {crosshair, skinQuery} from "./views.js";
import {Button, NumberInput, rowOf, softText} from "./widgets.js";
import {place, whole} from "./words.js";

/** The inputs. @param k  number of the constraint   @param patch  {path_mm, radius_mm} */
export function Patch({k, patch}) {
  const isPainting = state.placing === "patch" && state.patch.k === k;
  return h(
    "div",
    {"data-patch": patch.path_mm.length},
    rowOf(
      h(
        Button,
        {isPressed: isPainting, onClick: () => togglePainting(k), "data-do": "paint-patch"},
        isPainting ? "Painting on the skin" : "Paint on the skin",
      ),
      h(
        Button,
        {
          disabled: !patch.path_mm.length,
          onClick: () => putPatch(k, {...patch, path_mm: []}),
          "data-do": "clear-patch",
        },
        "Clear",
      ),
    ),
    isPainting ? h(Hint) : null,
    h(NumberInput, {
      label: "Radius",
      unit: "mm",
      value: patch.radius_mm,
      step: 0.5,
      min: 0.1,
      max: 50,
      onChange: (radius_mm) => putPatch(k, {...patch, radius_mm}),
    }),
    h(AtCrosshair, {k, patch}),
    h(Refused, {k}),
    patch.path_mm.length
      ? h(Points, {k, patch})
      : softText("There is no point yet. Until there is one, the case keeps the region that it had."),
  );
}

function Hint() {
  const text = isAtRest()
    ? "Drag over the skin; a drag beside it turns the view. A stroke goes on from the last point, so that a separate " +
      "place needs a constraint of its own. [ and ] change the radius, Esc ends painting."
    : "Patches are painted on the tissue at rest: move the slider below to rest.";
  return softText(text);
}

function AtCrosshair({k, patch}) {
  const at = crosshair(),
    query = skinQuery();
  return rowOf(
    h(
      Button,
      {
        disabled: !at || !query,
        onClick: () => paintPatch(k, patch, [query.nearest(at)]),
        "data-do": "patch-crosshair",
      },
      "Add the crosshair's place on the skin",
    ),
  );
}

function Refused({k}) {
  const {k: of, refused} = state.patch;
  if (of !== k || !refused) return null;
  return h(
    "p",
    {class: "problem", role: "alert"},
    `This stroke was not added: with it the patch would have ${whole(refused)} points, and ${whole(kMostPoints)} is ` +
      "the most. Paint with a larger radius.",
  );
}

function Points({k, patch}) {
  const [isOpen, setOpen] = useState(false),
    points = patch.path_mm;
  const remove = (i) => putPatch(k, {...patch, path_mm: points.toSpliced(i, 1)});
  return h(
    "details",
    {open: isOpen, onToggle: (event) => setOpen(event.target.open)},
    h("summary", null, points.length === 1 ? "1 point" : `${points.length} points`),
    isOpen
      ? h(
          "ol",
          {class: "strokes", "aria-label": "Points of the patch, mm"},
          points.map((point, i) =>
            h(
              "li",
              {key: i},
              h("span", {class: "name"}, `${i + 1}: ${point.map(place).join(", ")} mm`),
              h(Button, {onClick: () => remove(i), "aria-label": `Remove point ${i + 1}`}, "Remove"),
            ),
          ),
        )
      : null,
  );
}
