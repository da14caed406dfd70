#!/usr/bin/env bash
# Surprise: three@0.187.0: a robot's link names do not survive glTF: GLTFLoader deletes / . : and brackets from node
# names, puts _ for a space, and numbers what then collides. getObjectByName("left/gripper") finds nothing in the scene
# that was just loaded.
# Guess: the names of the file.
# Seen: left/gripper -> leftgripper, leftgripper -> leftgripper_1, panda.hand -> pandahand, "tool 0" -> tool_0; the true
# names are kept in userData.name.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
npm install --silent --no-fund --no-audit --prefix . three@0.187.0 > /dev/null
cat > run.mjs <<'EOF'
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

const names = ["left/gripper", "leftgripper", "panda.hand", "tool 0"];
const file = {
  asset: { version: "2.0" },
  scene: 0,
  scenes: [{ nodes: [0, 1, 2, 3] }],
  nodes: names.map((name) => ({ name })),
};
const { scene } = await new GLTFLoader().parseAsync(JSON.stringify(file), "");
const loaded = scene.children.map((child) => child.name);
names.forEach((name, i) => console.log(`${name} -> ${loaded[i]} (userData.name: ${scene.children[i].userData.name})`));
const found = scene.getObjectByName("left/gripper");
if (loaded.join() !== "leftgripper,leftgripper_1,pandahand,tool_0" || found !== undefined) {
  console.error("three.js now names the nodes of a glTF file otherwise.");
  process.exit(1);
}
EOF
node run.mjs
