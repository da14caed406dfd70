#!/usr/bin/env bash
# Surprise: gl-matrix@3.4.4 and wgpu-matrix@3.4.2: the angle between a unit quaternion and itself is NaN for about every
# second quaternion that their own normalize made, and 0 or up to 0.0008 rad for the others: acos of a single-precision
# product above 1.
# Guess: 0, or something like 1e-7.
# Seen: hundreds of 1000 random quaternions give NaN in both; two that are 1e-4 rad apart have the angle 0.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
npm install --silent --no-fund --no-audit --prefix . gl-matrix@3.4.4 wgpu-matrix@3.4.2 > /dev/null
cat > run.mjs <<'EOF'
import { quat as gl } from "gl-matrix";
import { quat as wgpu } from "wgpu-matrix";

let seed = 1;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
let nan = [0, 0];
let greatest = 0;
for (let i = 0; i < 1000; i++) {
  const q = gl.normalize(gl.create(), [random(), random(), random(), random()]);
  const angles = [gl.getAngle(q, q), wgpu.angle(q, q)];
  angles.forEach((angle, library) => (nan[library] += Number.isNaN(angle)));
  greatest = Math.max(greatest, angles[0] || 0);
}
const apart = gl.getAngle(gl.create(), gl.setAxisAngle(gl.create(), [0, 0, 1], 1e-4));
console.log(`NaN of 1000: gl-matrix ${nan[0]}, wgpu-matrix ${nan[1]}; greatest of the others ${greatest}`);
console.log(`1e-4 rad apart: ${apart}`);
if (!(nan.every((count) => count > 300 && count < 700) && greatest > 1e-4 && apart === 0)) {
  console.error("The angle of a quaternion to itself is now another one.");
  process.exit(1);
}
EOF
node run.mjs
