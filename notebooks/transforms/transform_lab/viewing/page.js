// Shows a scene in meshcat's viewer: its labels, fixed frame and camera, its animation or its controls. page.py packs it
// behind meshcat's own script.

window.CCapture = class {};  // meshcat's viewer makes one, for films

function showScene(buffer) {
  const [[told], base, ...states] = blocks(buffer), view = JSON.parse(new TextDecoder().decode(told));
  window.onmessage = null;  // meshcat's script leaves one that sends every message again, for making films
  const pane = document.getElementById("pane"), bar = document.getElementById("bar");
  const viewer = window.viewer = new MeshCat.Viewer(pane);
  const resize = viewer.set_3d_pane_size.bind(viewer);
  viewer.set_3d_pane_size = () => resize(pane.clientWidth, pane.clientHeight);  // and not as high as the window
  pane.querySelector("canvas").addEventListener("webglcontextlost", beginAnewWhenSeenAgain);
  const run = packets => packets.forEach(packet => viewer.handle_command_bytearray(packet));
  const object = path => viewer.scene_tree.find(path.split("/")).object;
  run(base);

  // Where everything stands: all is drawn in the root frame, and the root stands so that the fixed frame is the world.
  let fixed = view.frames[view.fixed];
  const root = object("meshcat");
  function settle() {
    const frame = object(fixed.path);
    frame.updateMatrix();
    frame.matrix.clone().invert().decompose(root.position, root.quaternion, root.scale);
    view.frames.forEach((other, i) => object(`grid${i}`).visible = other === fixed);
    viewer.set_dirty();
  }

  // The camera. three.js has y up: x, y, z of the fixed frame are x, -z, y there.
  viewer.camera.fov = view.fov;
  viewer.controls.screenSpacePanning = true;
  function look(name) {
    const [eye, target, distance] = fixed.cameras[name];
    viewer.camera.near = distance * view.nearest;
    viewer.camera.far = distance * 100;
    viewer.camera.position.set(eye[0], eye[2], -eye[1]);
    viewer.controls.target.set(target[0], target[2], -target[1]);
    viewer.camera.updateProjectionMatrix();
    viewer.controls.update();
    viewer.set_dirty();
  }
  // The wheel scrolls the notebook until the scene is clicked.
  viewer.controls.enableZoom = false;
  pane.addEventListener("pointerdown", () => viewer.controls.enableZoom = true);
  document.documentElement.addEventListener("mouseleave", () => viewer.controls.enableZoom = false);

  // Words: the labels beside what they name, and the text in the corner.
  const text = document.getElementById("text");
  let labels = [], last = "";
  function say({labels: found, text: words}) {
    text.textContent = words;
    if (last === (last = JSON.stringify(found))) return;
    labels.forEach(label => label.element.remove());
    labels = found.map(label => {
      const element = document.createElement("div");
      element.className = "label";
      element.textContent = label.text;
      if (label.subscript) element.appendChild(document.createElement("sub")).textContent = label.subscript;
      element.style.color = label.color;
      pane.append(element);
      return {...label, element};
    });
  }
  const render = viewer.render.bind(viewer);
  viewer.render = () => { render(); placeLabels(labels, viewer, pane, view, object); };

  // A state between two: 2.3 is three tenths of the way from the third to the fourth.
  const poses = states.map((packets, k) => {
    run(packets);
    return new Map(view.states[k].moving.map(i => {
      const {position, quaternion, scale} = object(view.moving[i]);
      return [view.moving[i], {position: position.clone(), quaternion: quaternion.clone(), scale: scale.clone()}];
    }));
  });
  let shown = null;
  function show(t) {
    const k = Math.min(Math.floor(t), states.length - 1), next = poses[k + 1];
    if (k !== shown) run(states[k]);
    for (const [path, pose] of poses[k]) {
      const here = object(path), to = next?.get(path);
      for (const part of ["position", "quaternion", "scale"]) here[part].copy(pose[part]);
      if (!to) continue;
      here.position.lerp(to.position, t - k);
      here.quaternion.slerp(to.quaternion, t - k);
      here.scale.lerp(to.scale, t - k);
    }
    const nearest = Math.min(Math.round(t), states.length - 1);
    say({labels: view.states[k].labels ?? view.labels, text: view.states[nearest].text});
    shown = k;
    settle();
  }

  // The bar below.
  const row = () => bar.appendChild(document.createElement("div"));
  const choice = (into, title, names, chosen, change) => {
    const select = document.createElement("select");
    names.forEach((name, i) => select.add(new Option(name, i, false, i === chosen)));
    select.addEventListener("change", () => change(select.selectedIndex));
    labelled(into, title, select);
    return select;
  };
  const first = row();
  const views = Object.keys(fixed.cameras);
  const caption = window.frameElement?.closest("figure")?.querySelector("figcaption");
  let seenFrom = view.seenFrom;
  choice(first, "Fixed frame", view.frames.map(frame => frame.name), view.fixed, i => {
    const named = text => text.replace(`Fixed frame ${fixed.name}. `, () => `Fixed frame ${view.frames[i].name}. `);
    if (caption) caption.textContent = named(caption.textContent);
    fixed = view.frames[i];
    settle();
    look(seenFrom);
  });
  choice(first, "Seen from", views, views.indexOf(seenFrom), i => look(seenFrom = views[i]));
  bar.addEventListener("submit", event => event.preventDefault());

  say(view);
  if (states.length) show(view.start);
  if (view.seconds) addPlayer(row(), states.length - 1, view.seconds, show);
  if (view.controls.length || view.live) addControls(view, row, choice, show, change => {
    run(blocks(change.packets)[0]);
    say(change);
    settle();
  });
  viewer.set_3d_pane_size();
  settle();
  look(seenFrom);
  viewer.render();
  followTheme(dark => view.frames.forEach((_, i) => {
    object(`grid${i}/<object>`).material.color.set(dark ? "#3f444d" : "#d8dce2");
    viewer.set_dirty();
  }));
  // A browser keeps some 16 scenes and drops the oldest; that one comes back when it is wanted.
  viewer.renderer.domElement.addEventListener("webglcontextlost", () => {
    pane.style.visibility = "hidden";
    document.body.className = "";
    document.documentElement.addEventListener("mouseenter", () => location.reload(), {once: true});
  });
}

// A sequence of lists of packets, each list and each packet behind its length.
function blocks(buffer) {
  const numbers = new DataView(buffer), found = [];
  let at = 0;
  const next = () => numbers.getUint32((at += 4) - 4);
  while (at < buffer.byteLength) {
    found.push(Array.from({length: next()}, () => {
      const size = next();
      return new Uint8Array(buffer, (at += size) - size, size);
    }));
  }
  return found;
}

// Light or dark, as the notebook around is; a page by itself, or one that may not look around, is light.
function followTheme(change) {
  let around;
  try { if (window.parent !== window) around = window.parent.document.body; } catch {}
  const dark = () => around?.dataset.jpThemeLight === "false" || around?.classList.contains("vscode-dark");
  const show = () => {
    document.body.className = dark() ? "dark" : "light";
    change(dark());
  };
  if (around) new MutationObserver(show).observe(around, {attributeFilter: ["data-jp-theme-light", "class"]});
  show();
}

function labelled(into, title, ...elements) {
  const label = into.appendChild(document.createElement("label"));
  label.append(title, ...elements);
  return label;
}

// Labels that have no fixed place stand where they cover least.
function placeLabels(labels, viewer, pane, view, object) {
  const width = pane.clientWidth, height = pane.clientHeight, project = (label, along) => {
    const p = viewer.camera.position.clone().set(...label.position).multiplyScalar(along);
    p.applyMatrix4(object(label.path).matrixWorld);
    const depth = -p.clone().applyMatrix4(viewer.camera.matrixWorldInverse).z;
    p.project(viewer.camera);
    return {x: (p.x + 1) / 2 * width, y: (1 - p.y) / 2 * height, depth};
  };
  const taken = [];  // centre, half width and half height of what is drawn, and how bad it is to cover that
  for (const label of labels) {
    const marks = label.near === "thing" ? [1] : [0.3, 0.6, 0.8];  // the thing named, or along the axis to its letter
    for (const along of marks) taken.push({...project(label, along), w: 4, h: 4, bad: 1});
  }
  for (const label of labels) {
    const {x, y, depth} = project(label, 1), style = label.element.style;
    if (label.height) {  // of a capital letter, in metres
      Object.assign(style, {fontFamily: '"Liberation Sans", Arial, sans-serif', fontWeight: "normal", textAlign: "left"});
      style.fontSize = `${label.height / 0.72 * height / (2 * depth * Math.tan(view.fov / 360 * Math.PI))}px`;
    }
    const w = label.element.offsetWidth / 2, h = label.element.offsetHeight / 2;
    let best = {bad: Infinity}, along = {x: w, y: 0}, across = {x: 0, y: -2 * h};
    if (label.near === "tip") {
      const before = project(label, 0.9), length = Math.hypot(x - before.x, y - before.y) || 1;
      along = {x: (x - before.x) / length * 2 * h, y: (y - before.y) / length * 2 * h};
      across = {x: along.y, y: -along.x};
    }
    const candidates = (PLACES.near[label.near] ?? [[0, 0]]).map(
      ([one, other]) => [x + one * along.x + other * across.x, y + one * along.y + other * across.y]);
    const preferred = candidates.length;
    if (label.near) candidates.push(...PLACES.around.map(([right, up]) => [x + right * 2 * h, y - up * 2 * h]));
    for (const [number, [placeX, placeY]] of candidates.entries()) {
      if (best.bad === 0 || number >= preferred && best.bad < 20) break;
      const place = {x: placeX, y: placeY, w, h, bad: 0};
      if (Math.min(place.x, width - place.x) < w || Math.min(place.y, height - place.y) < h) place.bad += 20;
      for (const t of taken) {
        if (Math.abs(place.x - t.x) < w + t.w && Math.abs(place.y - t.y) < h + t.h) place.bad += t.bad;
      }
      if (place.bad < best.bad) best = place;
    }
    const outside = depth < viewer.camera.near || x < 0 || y < 0 || x > width || y > height;
    style.visibility = outside ? "hidden" : "";  // as the pane, which is hidden on paper
    style.transform = `translate(${best.x - w}px, ${best.y - h}px)`;
    if (!outside) taken.push({...best, bad: 20});
  }
}

// A browser keeps some sixteen scenes alive. One that it has let go shows its still picture until somebody comes back to it;
// one that is looked at meanwhile begins anew at once, but not twice, or they would push out each other for ever.
function beginAnewWhenSeenAgain() {
  const frame = window.frameElement;
  let away = false;
  document.body.style.visibility = "hidden";
  if (frame) new IntersectionObserver(([{isIntersecting}]) => {
    if (isIntersecting && (away || !frame.dataset.again)) {
      frame.dataset.again = true;
      frame.srcdoc += "";
    }
    away ||= !isIntersecting;
  }).observe(document.body);
}

// Play, pause, and a slider that shows the way from the first state to the last.
function addPlayer(row, last, seconds, show) {
  const button = row.appendChild(document.createElement("button")), slider = document.createElement("input");
  Object.assign(slider, {type: "range", min: 0, max: last, step: "any", value: last, className: "wide"});
  slider.setAttribute("aria-label", "Time");
  row.append(slider);
  let before = null;
  const title = () => {
    button.textContent = before === null ? "▶ Play" : "❚❚ Pause";
    slider.setAttribute("aria-valuetext", `${Math.round(slider.value / last * seconds * 10) / 10} of ${seconds} seconds`);
  };
  function step(now) {
    if (before === null) return;
    slider.value = Math.min(last, +slider.value + (now - before) / 1000 / seconds * last);
    before = +slider.value < last ? now : null;
    show(+slider.value);
    before === null ? title() : requestAnimationFrame(step);
  }
  button.type = "button";
  button.addEventListener("click", () => {
    if (before === null && +slider.value >= last) slider.value = 0;
    before = before === null ? performance.now() : null;
    title();
    requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => { before = null; title(); show(+slider.value); });
  title();
}

// Sliders and drop-downs. The kernel computes what they show while it listens; where there is none, in a saved notebook,
// it is shown from the states that were computed beforehand.
function addControls(view, row, choice, show, change) {
  const values = view.controls.map(control => control.index);  // of each control: which of its values it has
  let heard = false, moves = 0, asked = 0, unanswered = 0, local = false, timer;
  const post = message => {
    if (window.parent === window || !view.live) return;
    window.parent.postMessage({from: "page", message: {scene: view.live, number: null, values, ...message}}, "*");
  };
  const greet = () => post({everything: true});
  function moved(i, value) {
    values[i] = value;
    moves++;
    heard ? ask() : showState();
  }
  function ask() {  // a few questions at a time, so that no queue builds up
    clearTimeout(timer);
    timer = setTimeout(showState, 1000);  // the kernel is busy or gone
    if (unanswered >= 3 || asked === moves) return;
    unanswered++;
    asked = moves;
    post({everything: local, number: asked});
    local = false;
  }
  function showState() {  // the nearest of those computed beforehand
    unanswered = 0;
    if (!view.states.length) return note.hidden = false;
    local = true;
    let state = 0;
    view.controls.forEach(({sampled}, i) => {
      const distance = sampled.map(value => Math.abs(value - values[i]));
      state = state * sampled.length + distance.indexOf(Math.min(...distance));
    });
    show(state);
  }
  view.controls.forEach((control, i) => {
    const into = row();
    if (control.kind === "slider") {
      const slider = document.createElement("input"), output = document.createElement("output");
      Object.assign(slider, {type: "range", min: 0, max: control.values.length - 1, value: values[i]});
      slider.name = control.name;
      const write = () => {
        output.textContent = control.values[slider.value];
        slider.setAttribute("aria-valuetext", output.textContent);
      };
      slider.addEventListener("input", () => { write(); moved(i, +slider.value); });
      write();
      labelled(into, control.name, slider, output).className = "wide";
    } else {
      choice(into, control.name, control.values, values[i], value => moved(i, value)).name = control.name;
    }
  });
  const note = Object.assign(document.createElement("em"), {textContent: "Run the cell to move this.", hidden: true});
  if (view.controls.length) document.getElementById("bar").lastChild.append(note);
  window.addEventListener("message", ({data}) => {
    if (data?.from !== "kernel") return;
    const {message, packets} = data;
    if (message.hello) return greet();
    if (message.scene !== view.live) return;
    heard = true;
    note.hidden = true;
    change({...message, packets});
    if (message.number === null) return;  // not an answer, but what the kernel had to say of its own
    clearTimeout(timer);
    unanswered = Math.max(unanswered - 1, 0);
    if (moves !== asked) ask();
  });
  greet();
}
