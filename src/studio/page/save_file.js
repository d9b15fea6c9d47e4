// Files that the page hands to the person.

/** Offers something to be saved. @param content  a text or a typed array   @param type  such as "text/plain" */
export function saveFile(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
