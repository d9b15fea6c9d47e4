// The buttons that take back what was changed by hand in step See, or make it again.

import {h} from "preact";
import {state} from "./store.js";
import {nameInText} from "./fields.js";
import {lastChange, redo, undo} from "./history.js";
import {Button} from "./widgets.js";

/** Both; each names the setting that it changes. */
export function UndoButtons() {
  return [
    h(Way, {key: "undo", verb: "Undo", onClick: undo, keys: "Ctrl+Z", of: lastChange()}),
    h(Way, {key: "redo", verb: "Redo", onClick: redo, keys: "Ctrl+Y", of: state.history.future.at(-1)}),
  ];
}

function Way({verb, onClick, keys, of}) {
  const text = of ? `${verb}: ${nameInText(of.key)}` : verb;
  return h(Button, {disabled: !of, onClick, title: keys, "data-do": verb.toLowerCase()}, text);
}
