// Numbers and names as a person reads them.

const kUnitAtEnd = /_(mm_s2|kpa_mm2|mm_s|mm3|mm2|mm|hu|kpa|deg|s|w)$/;

/** A length in mm with two decimals and its unit; a dash where there is none. */
export function mm(value) {
  return isNumber(value) ? `${fixed(value, 2)} mm` : "–";
}

/** A coordinate in mm with one decimal, without its unit. */
export function place(value) {
  return fixed(value, 1);
}

/** A number with so many decimals and a true minus sign; never "−0". */
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** A number for an input: at most four decimals, no needless zeros. */
export function plain(value) {
  return isNumber(value) ? String(Number(value.toFixed(4))) : "";
}

/** About how long something takes: "9 s", "3 min". */
export function duration(seconds) {
  if (!isNumber(seconds)) return "";
  return seconds < 90 ? `${Math.max(1, Math.round(seconds))} s` : `${Math.round(seconds / 60)} min`;
}

/** A whole number with narrow spaces between thousands. */
export function whole(value) {
  return Math.round(value).toLocaleString("en").replaceAll(",", "\u202f");
}

/** Bytes as "12.3 MB". */
export function size(bytes) {
  if (!isNumber(bytes)) return "";
  const k = bytes < 1000 ? 0 : bytes < 1e6 ? 1 : bytes < 1e9 ? 2 : 3;
  return `${(bytes / 1000 ** k).toFixed(k ? 1 : 0)} ${["B", "kB", "MB", "GB"][k]}`;
}

/** Whether a value is a finite number. */
export function isNumber(value) {
  return typeof value === "number" && Number.isFinite(value);
}

/** Whether a setting's name ends in a unit. */
export function hasUnitInName(key) {
  return kUnitAtEnd.test(key);
}

/** The name of a setting for a person: "plan.lateral_margin_mm" is "Lateral margin". */
export function nameOf(key) {
  const words = key.split(".").pop().replace(kUnitAtEnd, "").replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** A word of the interface with a capital and spaces: "open_layer" is "Open layer". */
export function spoken(word) {
  return word ? nameOf(String(word)) : "";
}
