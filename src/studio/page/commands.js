// Commands that repeat what the page did, to be copied into a shell.

import {h} from "preact";
import {useState} from "preact/hooks";
import {Button} from "./widgets.js";

/** Lines of commands with a button that copies them, and the names of files that were written. */
export function Commands({lines = [], files = []}) {
  const [isCopied, setCopied] = useState(false);
  const shown = lines.filter(Boolean);
  const copy = async () => {
    await navigator.clipboard.writeText(`${shown.join("\n")}\n`);
    setCopied(true);
    setTimeout(() => setCopied(false), 2000);
  };
  return [
    files.length ? h("p", {key: "files", class: "path"}, `Written: ${files.join(", ")}.`) : null,
    shown.length
      ? h(
          "div",
          {key: "commands", class: "commands", "data-commands": shown.length},
          h("pre", {tabIndex: 0, role: "region", "aria-label": "Commands that repeat this"}, shown.join("\n")),
          h(Button, {onClick: copy, "data-do": "copy"}, isCopied ? "Copied" : "Copy"),
        )
      : null,
  ];
}
