#!/usr/bin/env bash
# Surprise: cannon-es@0.20.0: setFromEuler and toEuler of the same class have different default orders (XYZ and YZX), so
# the angles that were put in do not come out; and toEuler knows no other order than its own.
# Guess: q.setFromEuler(0.3, 0.5, 0.7) followed by q.toEuler(v) gives 0.3, 0.5, 0.7.
# Seen: 0.3853, 0.2339, 0.8093; asked for "XYZ", toEuler throws.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
npm install --silent --no-fund --no-audit --prefix . cannon-es@0.20.0 > /dev/null
cat > run.mjs <<'EOF'
import { Quaternion, Vec3 } from "cannon-es";

const turn = new Quaternion().setFromEuler(0.3, 0.5, 0.7);
const out = new Vec3();
turn.toEuler(out);
const angles = out.toArray().map((angle) => angle.toFixed(4)).join(" ");
let refused = false;
try {
  turn.toEuler(new Vec3(), "XYZ");
} catch {
  refused = true;
}
console.log("in: 0.3 0.5 0.7, out:", angles, "- order XYZ refused:", refused);
if (angles !== "0.3853 0.2339 0.8093" || !refused) {
  console.error("cannon-es now gives other angles back.");
  process.exit(1);
}
EOF
node run.mjs
