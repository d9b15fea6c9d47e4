// Installs the packages of package.json into a folder, unless they are there: node install_packages.mjs NPM FOLDER
// Ends with 77 (SKIPPED) where npm cannot reach its registry.

import {spawnSync} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {fileURLToPath} from "node:url";

const kHere = path.dirname(fileURLToPath(import.meta.url));
const kLock = "package-lock.json";
const kDone = "installed.json"; // the lock file of what is installed
const kRetries = ["--fetch-retry-mintimeout=1000", "--fetch-retry-maxtimeout=5000"];
const kOptions = ["--ignore-scripts", "--no-audit", "--no-fund", ...kRetries];
// The codes of npm for no answer, and for the answer of a gateway.
const kUnreachable = new Set(
  ("E502 E503 E504 EAI_AGAIN ECONNABORTED ECONNREFUSED ECONNRESET EHOSTUNREACH EIDLETIMEOUT ENETUNREACH ENOTFOUND " +
    "EPIPE ERR_SOCKET_TIMEOUT ETIMEDOUT FETCH_ERROR").split(" "),
);

const [npm, folder] = process.argv.slice(2);
const lock = fs.readFileSync(path.join(kHere, kLock), "utf8"),
  done = path.join(folder, kDone);
if (fs.existsSync(done) && fs.readFileSync(done, "utf8") === lock) {
  console.log(`The packages of ${kLock} are in ${folder}.`);
  process.exit(0);
}
fs.mkdirSync(folder, {recursive: true});
for (const name of ["package.json", kLock]) fs.copyFileSync(path.join(kHere, name), path.join(folder, name));
const {status, error, stdout, stderr} = spawnSync(npm, ["ci", ...kOptions], {cwd: folder, encoding: "utf8"});
if (error) throw error;
console.log(stdout + stderr);
if (status === 0) {
  fs.writeFileSync(done, lock);
  process.exit(0);
}
const [, code] = /^npm (?:ERR!|error) code (\w+)$/m.exec(stderr) || [];
if (!kUnreachable.has(code)) process.exit(1);
console.log("SKIPPED: npm cannot reach its registry");
process.exit(77);
