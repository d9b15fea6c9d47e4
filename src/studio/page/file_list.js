// The server's folders: a list to walk through, and a choice of one file of some kinds.

import {h} from "preact";
import {useEffect} from "preact/hooks";
import {state} from "./store.js";
import {list, listNearCase} from "./actions.js";
import {Button, Choice, Problems, Working, softText} from "./widgets.js";
import {size, spoken} from "./words.js";

const kSigns = {folder: "▸", scan: "▤", labels: "▦", mesh: "▲", surface: "△", case: "◆"};

/** The folder that is listed, with the way up.
 *  @param actOf  (file): what a click on it does, or null   @param isChosen  (file); undefined: none is kept
 *  @param empty  what is said of a folder without entries */
export function FileList({actOf, isChosen, empty}) {
  const {files} = state;
  if (!files)
    return h("div", null, h(Working, {call: "files", text: "Reading the folder"}), h(Problems, {calls: ["files"]}));
  const {roots = [], folder, up, entries = []} = files;
  const roomOf = (id) => (roots.some((root) => root.id === id) ? id : "");
  return h(
    "div",
    null,
    roots.length > 1
      ? h(Choice, {
          label: "Start from",
          value: roomOf(folder.id),
          onChange: (id) => id && list(id),
          options: [["", "…"], ...roots.map((root) => [root.id, root.name])],
        })
      : null,
    h(
      "div",
      {class: "row between"},
      h("strong", {class: "path"}, folder.name),
      h(Button, {disabled: !up, onClick: () => list(up)}, "Up"),
    ),
    h(
      "ul",
      {class: "files", "aria-label": `Files in ${folder.name}`},
      entries.map((file) => h(FileRow, {key: file.id, file, act: actOf(file), isChosen: isChosen && isChosen(file)})),
    ),
    entries.length ? null : softText(empty),
    files.left_out ? softText(`${files.left_out} more are not shown.`) : null,
    h(Problems, {calls: ["files"]}),
  );
}

function FileRow({file, act, isChosen}) {
  const words = [spoken(file.kind), file.bytes ? size(file.bytes) : ""].filter(Boolean);
  const about = h("span", {class: "soft"}, words.join(", "));
  const name = [
    h("span", {class: "sign", "aria-hidden": "true"}, kSigns[file.kind] || "·"),
    h("span", {class: "name"}, file.name),
    about,
  ];
  if (!act) return h("li", {class: "file"}, name);
  return h(
    "li",
    null,
    h(
      "button",
      {
        type: "button",
        class: "file",
        "data-kind": file.kind,
        "data-file": file.name,
        "aria-pressed": isChosen === undefined ? undefined : String(isChosen),
        onClick: act,
      },
      name,
    ),
  );
}

/** A choice of one file whose name ends in one of `endings`; folders are walked through, other files are faint.
 *  @param chosen  the file, or null   @param id  of the choice, for tests */
export function FilePicker({label, endings, chosen, onChoose, id}) {
  useEffect(() => {
    if (!state.files) listNearCase();
  }, []);
  const isFitting = (file) => endings.some((ending) => file.name.toLowerCase().endsWith(ending));
  const actOf = (file) => {
    if (isFolder(file)) return () => list(file.id);
    return isFitting(file) ? () => onChoose(file) : null;
  };
  return h(
    "details",
    {class: "picker", "data-picker": id, open: !chosen, key: chosen ? chosen.id : ""},
    h("summary", null, chosen ? `Choose another ${label}` : `Choose a ${label} (${endings.join(", ")})`),
    h(FileList, {actOf, isChosen: (file) => Boolean(chosen) && chosen.id === file.id, empty: "This folder is empty."}),
  );
}

// A case or a scan may be a folder as well as a file; only files have bytes.
function isFolder(file) {
  return file.kind === "folder" || (["case", "scan"].includes(file.kind) && !file.bytes);
}
