#!/bin/sh
# Fetches the page's libraries anew as package-lock.json pins them (checked by its hashes), and prints what it copied.
# After a change of package.json:  ./renew.sh --lock  writes package-lock.json first.
set -eu
here=$(cd "$(dirname "$0")" && pwd)

# package/file in it, and its name in lib/: the only list.
files="
three/build/three.module.js            three.module.js
three/build/three.core.js              three.core.js
three-mesh-bvh/build/index.module.js   three-mesh-bvh.module.js
uplot/dist/uPlot.esm.js                uPlot.esm.js
uplot/dist/uPlot.min.css               uPlot.min.css
preact/dist/preact.mjs                 preact.js
preact/hooks/dist/hooks.mjs            preact-hooks.js
"
packages="three three-mesh-bvh uplot preact"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$here/package.json" .
if [ "${1:-}" = --lock ]; then
  npm install --package-lock-only --ignore-scripts --no-audit --no-fund --omit-lockfile-registry-resolved
  # The lock pins by hash and names no host: it is fetched from wherever npm is set to.
  node -e 'const fs = require("fs"), lock = JSON.parse(fs.readFileSync("package-lock.json"));
           for (const entry of Object.values(lock.packages)) delete entry.funding;
           fs.writeFileSync("package-lock.json", JSON.stringify(lock, null, 2) + "\n");'
  cp package-lock.json "$here/"
fi
cp "$here/package-lock.json" .
npm ci --ignore-scripts --no-audit --no-fund

rm -rf "$here/lib" "$here/licences"
mkdir "$here/lib" "$here/licences"
echo "$files" | while read -r from to; do
  [ -z "$from" ] || cp "node_modules/$from" "$here/lib/$to"
done
for package in $packages; do cp "node_modules/$package/LICENSE" "$here/licences/$package.txt"; done
# Shortened, as three does not publish it; notices of copyright stay.
for module in "$here"/lib/*.js; do
  node_modules/.bin/terser "$module" --module --compress --mangle --comments '/copyright|@license/i' --output "$module"
done
cd "$here"
sha256sum lib/* licences/*
