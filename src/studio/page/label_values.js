// Which labels of a given label volume are tissue: `ct.label_values`.

import {h} from "preact";
import {state, setting} from "./store.js";
import {change} from "./actions.js";
import {Button, Section, complaint, problemAt, softText} from "./widgets.js";
import {whole} from "./words.js";

const kPath = "ct.label_values";

/** The section: a box for each label that was found, with its voxels. */
export function LabelValues() {
  const found = (state.tissue && state.tissue.given_labels) || [],
    chosen = setting(kPath),
    problem = problemAt(kPath);
  return h(
    Section,
    {title: "Which labels are tissue", id: "labels"},
    softText(`${state.case.inputs["ct.labels"]} says what each voxel is. The labels that are checked are tissue.`),
    found.length
      ? h(
          "ul",
          {class: "labels"},
          found.map((label) => h("li", {key: label.value}, h(Label, {label, found, chosen}))),
        )
      : null,
    problem ? h("p", {class: "problem", role: "alert"}, complaint(problem)) : null,
    chosen ? h(Button, {onClick: () => change({[kPath]: null}), "data-do": "all-labels"}, "Take all labels") : null,
  );
}

function Label({label, found, chosen}) {
  const {value, voxels} = label;
  const isOn = (other) => !chosen || chosen.includes(other),
    isLast = isOn(value) && found.filter((one) => isOn(one.value)).length === 1; // without any there is no specimen
  const set = (isWanted) => {
    const wanted = found.map((one) => one.value).filter((other) => (other === value ? isWanted : isOn(other)));
    change({[kPath]: wanted.length === found.length ? null : wanted});
  };
  return h(
    "label",
    {class: "check", "data-label": value},
    h("input", {
      type: "checkbox",
      checked: isOn(value),
      disabled: isLast,
      onChange: (event) => set(event.target.checked),
    }),
    h("span", null, `Label ${value}`),
    h("span", {class: "soft"}, `${whole(voxels)} voxels`),
  );
}
