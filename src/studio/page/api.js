// Calls to the server, the arrays that they give, and the stream of its events.

const kTokenName = "incise-token";
const kArrays = {int16: Int16Array, uint8: Uint8Array, uint32: Uint32Array, float32: Float32Array};

/** The token of the URL's fragment; kept for this tab, so that a reload without the fragment works. */
function readToken() {
  const found = new URLSearchParams(window.location.hash.slice(1)).get("token");
  if (found) window.sessionStorage.setItem(kTokenName, found);
  return found || window.sessionStorage.getItem(kTokenName) || "";
}

const token = readToken();

/** An answer that is no result. `kind`: "problem" (422, with `problem`), "changed" (409), "stopped" (499),
 *  "crashed" (500), "denied" (401, 403) or "lost" (no answer). */
export class CallError extends Error {
  constructor(kind, message, problem = null) {
    super(message);
    this.kind = kind;
    this.problem = problem;
  }
}

const kKinds = {401: "denied", 403: "denied", 409: "changed", 422: "problem", 499: "stopped", 500: "crashed"};

async function ask(address, options = {}) {
  const headers = {"X-Incise-Token": token, ...options.headers};
  try {
    return await fetch(address, {...options, headers, cache: "no-store"});
  } catch {
    throw new CallError("lost", "The studio's server does not answer.");
  }
}

async function failureOf(response) {
  const body = await response.json().catch(() => ({}));
  const problem = body.problem || null;
  const message = (problem && problem.message) || body.message || `The server answered with status ${response.status}.`;
  return new CallError(kKinds[response.status] || "crashed", message, problem);
}

/** Calls NAME with arguments. Arrays of the result stay references until load().
 *  @param options  of fetch()
 *  @throws CallError */
export async function call(name, args = {}, options = {}) {
  const response = await ask(`/api/call/${name}`, {
    ...options,
    method: "POST",
    headers: {"Content-Type": "application/json"},
    body: JSON.stringify(args),
  });
  if (!response.ok) throw await failureOf(response);
  return response.json();
}

/** One array of a result: a typed array. @throws CallError */
async function fetchArray(reference) {
  const response = await ask(`/api/blob/${encodeURIComponent(reference.blob)}`);
  if (!response.ok) throw await failureOf(response);
  const array = new kArrays[reference.type](await response.arrayBuffer());
  if (array.length === reference.count) return array;
  throw new CallError("crashed", `The server sent ${array.length} numbers in place of ${reference.count}.`);
}

/** A copy of a result with every reference to an array replaced by the array. @throws CallError */
export async function load(value) {
  if (value === null || typeof value !== "object") return value;
  if (typeof value.blob === "string") return fetchArray(value);
  if (Array.isArray(value)) return isPlain(value) ? value : Promise.all(value.map(load));
  const pairs = await Promise.all(Object.entries(value).map(async ([key, part]) => [key, await load(part)]));
  return Object.fromEntries(pairs);
}

// Lists of points and numbers hold no references; they are long, so they are not walked.
function isPlain(list) {
  const first = list[0];
  return list.length === 0 || typeof first !== "object" || first === null || Array.isArray(first);
}

/** Reads the events for as long as the page lives, and connects again when the stream breaks.
 *  @param onEvent  (name, data)
 *  @param onLink   "open", "lost" or "denied" */
export async function listen(onEvent, onLink) {
  for (let pause = 500; ; pause = Math.min(8000, 1.7 * pause)) {
    try {
      const response = await ask("/api/events");
      if (!response.ok) throw await failureOf(response);
      onLink("open");
      pause = 500;
      await readEvents(response.body.getReader(), onEvent);
      onLink("lost");
    } catch (error) {
      onLink(error.kind === "denied" ? "denied" : "lost");
    }
    await new Promise((resolve) => {
      setTimeout(resolve, pause);
    });
  }
}

async function readEvents(reader, onEvent) {
  const decoder = new TextDecoder();
  let text = "";
  for (;;) {
    const {done, value} = await reader.read();
    if (done) return;
    text = (text + decoder.decode(value, {stream: true})).replaceAll("\r\n", "\n");
    const blocks = text.split("\n\n");
    text = blocks.pop();
    for (const block of blocks) takeEvent(block, onEvent);
  }
}

function takeEvent(block, onEvent) {
  const lines = block.split("\n");
  const valueOf = (key) =>
    lines.filter((line) => line.startsWith(key + ":")).map((line) => line.slice(key.length + 1).replace(/^ /, ""));
  const data = valueOf("data").join("\n");
  if (data) onEvent(valueOf("event")[0] || "message", JSON.parse(data));
}
