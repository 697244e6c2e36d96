/* dofkit's player: draws a sketch on a canvas, plays its motions, and turns it where it is of space.
   Part of dofkit, under its MIT licence; it uses no other library and fetches nothing. */
"use strict";
(function () {
  const opened = performance.now(), data = JSON.parse(document.getElementById("data").textContent);
  const canvas = document.querySelector("canvas");
  const pen = canvas.getContext("2d");
  const program = data.program, solid = data.dimension === 3, planar = program && planarScene(program);
  /* `free`: coordinates to which a point was dragged; `off`: the constraints that are left out. */
  const state = { clip: 0, frame: 0, playing: false, azimuth: data.view[0], elevation: data.view[1], free: null, off: new Set() };
  const night = window.matchMedia("(prefers-color-scheme: dark)");
  let hatch = makeHatch();
  for (const shape of data.shapes) {
    shape.v = shape.v || Array.from({ length: shape.p.length / 3 }, function (_, k) { return [shape.n, ...shape.p.slice(3 * k, 3 * k + 3)]; });
  }

  /* A colour as it is on the paper that is shown: light, or dark where the reader has it so. */
  function tone(colour) { return night.matches && data.dark[colour] || colour; }

  function makeHatch() {
    const tile = document.createElement("canvas");
    tile.width = tile.height = 7;
    const ink = tile.getContext("2d");
    ink.strokeStyle = tone("#8A8A8A");
    ink.lineWidth = 0.8;
    ink.beginPath();
    for (const shift of [-7, 0, 7]) { ink.moveTo(shift, 7); ink.lineTo(shift + 7, 0); }
    ink.stroke();
    return pen.createPattern(tile, "repeat");
  }

  function rows() {
    if (!solid) { return [[1, 0, 0], [0, 1, 0], [0, 0, 1]]; }
    const a = state.azimuth * Math.PI / 180, e = state.elevation * Math.PI / 180;
    return [
      [-Math.sin(a), Math.cos(a), 0],
      [-Math.cos(a) * Math.sin(e), -Math.sin(a) * Math.sin(e), Math.cos(e)],
      [Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)]
    ];
  }

  function dot(row, p) { return row[0] * p[0] + row[1] * p[1] + row[2] * p[2]; }

  /* A pose as nine numbers of a rotation, by rows, and a shift: from the vector part of a unit quaternion. */
  function posed(row) {
    const [x, y, z] = row.length > 3 ? row.slice(3) : [0, 0, 0], w = Math.sqrt(Math.max(0, 1 - x * x - y * y - z * z));
    return { turn: [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
      2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], shift: row.slice(0, 3) };
  }

  function moved(pose, p) {
    return [0, 1, 2].map(function (k) { return dot(pose.turn.slice(3 * k, 3 * k + 3), p) + pose.shift[k]; });
  }

  const still = planar ? planar.placed(program.start) : data.still.map(posed);

  function posesOf(clip) {
    clip.poses = clip.poses || clip.frames.map(planar ? planar.placed : function (frame) {
      return frame.map(function (row, k) { return posed(row || data.still[k]); });
    });
    return clip.poses;
  }

  function poses() {
    const clip = data.clips[state.clip];
    return state.free ? planar.placed(state.free) : clip ? posesAt(clip, state.frame) : still;
  }

  /* The poses of a clip at a frame, or between two: there on the straight line from one to the other. */
  function posesAt(clip, frame) {
    const all = posesOf(clip), k = Math.floor(frame), part = frame - k;
    return part ? all[k].map(function (pose, c) { return blended(pose, all[(k + 1) % all.length][c], part); }) : all[k];
  }

  function blended(a, b, part) {
    function mixed(key) { return a[key].map(function (x, k) { return x + part * (b[key][k] - x); }); }
    function unit(v) { const size = Math.hypot(...v) || 1; return v.map(function (x) { return x / size; }); }
    function cross(u, v) { return [0, 1, 2].map(function (k) { return u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]; }); }
    const turn = mixed("turn"), x = unit(turn.slice(0, 3)), z = unit(cross(x, turn.slice(3, 6)));
    return { turn: [...x, ...cross(z, x), ...z], shift: mixed("shift") };
  }

  /* A vertex on the panel: to the right, down, and how near. */
  function seen(vertex, here, view) { return onPanel(moved(here[vertex[0]], vertex.slice(1)), view); }

  function hullOf(points, pad) {
    const cloud = [];
    for (const p of points) {
      for (let k = 0; k < 24; k++) {
        const a = 2 * Math.PI * k / 24;
        cloud.push([p[0] + pad * Math.cos(a), p[1] + pad * Math.sin(a)]);
      }
    }
    cloud.sort(function (a, b) { return a[0] - b[0] || a[1] - b[1]; });
    function half(list) {
      const found = [];
      for (const p of list) {
        while (found.length > 1) {
          const a = found[found.length - 2], b = found[found.length - 1];
          if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) { break; }
          found.pop();
        }
        found.push(p);
      }
      found.pop();
      return found;
    }
    return half(cloud).concat(half(cloud.reverse()));
  }

  function coil(a, b, wide) {
    const x = b[0] - a[0], y = b[1] - a[1], size = Math.hypot(x, y) || 1, found = [a];
    function at(s, off) { found.push([a[0] + s * x - off * y / size, a[1] + s * y + off * x / size]); }
    at(0.2, 0);
    for (let k = 0; k < 12; k++) { at(0.2 + 0.6 * (k + 0.5) / 12, k % 2 ? -wide : wide); }
    at(0.8, 0);
    found.push(b);
    return found;
  }

  function bow(a, b, high) {
    const x = b[0] - a[0], y = b[1] - a[1], found = [], up = x > 0 ? -1 : 1;
    for (let k = 0; k <= 16; k++) {
      const t = Math.PI * k / 16, s = (1 - Math.cos(t)) / 2, off = up * high * Math.sin(t);
      found.push([a[0] + s * x - off * y, a[1] + s * y + off * x]);
    }
    return found;
  }

  /* A line with a head at its end. */
  function arrow(a, b, head) {
    const x = b[0] - a[0], y = b[1] - a[1], back = Math.min(head / (Math.hypot(x, y) || 1), 0.5);
    const foot = [b[0] - back * x, b[1] - back * y], side = [0.45 * back * y, -0.45 * back * x];
    trace([a, b, [foot[0] + side[0], foot[1] + side[1]], b, [foot[0] - side[0], foot[1] - side[1]]], false);
  }

  function onPanel(p, view) {
    const q = [p[0] - data.centre[0], p[1] - data.centre[1], p[2] - data.centre[2]];
    return [data.shift[0] + data.scale * dot(view[0], q),
      data.height - data.shift[1] - data.scale * dot(view[1], q), dot(view[2], q)];
  }

  /* Paths of vertices: of a loop as far as it has gone, with the displacement at its end as an arrow; velocities. */
  function drawPaths(view) {
    const clip = data.clips[state.clip];
    if (!clip || state.free) { return; }
    for (const [from, to] of Math.abs(state.frame - clip.start) < 2 ? clip.arrows : []) {
      arrow(onPanel(from, view), onPanel(to, view), 8);
      paint(["#D55E00", 2, [], null], false);
    }
    const until = clip.loop ? Math.floor(state.frame) + 1 : clip.frames.length;
    for (const vertex of controls.paths.checked || clip.loop ? data.traced : []) {
      const path = posesOf(clip).slice(0, until).map(function (here) { return seen(vertex, here, view); });
      trace(path, Boolean(clip.closed));
      paint(["#CC79A7", 1.3, [], null], false);
      const end = path[path.length - 1];
      if (clip.loop && until === clip.frames.length && Math.hypot(end[0] - path[0][0], end[1] - path[0][1]) > 1) {
        arrow(path[0], end, 8);
        paint(["#D55E00", 2, [], null], false);
      }
    }
  }

  function trace(points, closed) {
    pen.beginPath();
    points.forEach(function (p, k) { if (k) { pen.lineTo(p[0], p[1]); } else { pen.moveTo(p[0], p[1]); } });
    if (closed) { pen.closePath(); }
  }

  function paint(look, closed) {
    if (closed && look[3]) {
      pen.globalAlpha = look[4];
      pen.fillStyle = tone(look[3]);
      pen.fill();
      pen.globalAlpha = 1;
      if (look[5]) { pen.globalAlpha = 0.6; pen.fillStyle = hatch; pen.fill(); pen.globalAlpha = 1; }
    }
    pen.strokeStyle = tone(look[0]);
    pen.lineWidth = look[1];
    pen.setLineDash(look[2]);
    pen.stroke();
  }

  /* A smooth line through points: the spline of Catmull and Rom. */
  function smooth(points) {
    const last = points.length - 1, closed = Math.hypot(points[0][0] - points[last][0], points[0][1] - points[last][1]) < 1e-3;
    function slope(k, c) {
      if (closed && k % last === 0) { return (points[1][c] - points[last - 1][c]) / 6; }
      const a = Math.max(k - 1, 0), b = Math.min(k + 1, last);
      return (points[b][c] - points[a][c]) / (b - a) / 3;
    }
    pen.beginPath();
    pen.moveTo(points[0][0], points[0][1]);
    for (let k = 0; k < last; k++) {
      const p = points[k], q = points[k + 1];
      pen.bezierCurveTo(p[0] + slope(k, 0), p[1] + slope(k, 1), q[0] - slope(k + 1, 0), q[1] - slope(k + 1, 1), q[0], q[1]);
    }
  }

  function drawShape(shape, points, look) {
    if (shape.k === "ball") {
      pen.beginPath();
      pen.arc(points[0][0], points[0][1], shape.s * data.scale, 0, 2 * Math.PI);
      paint(look, true);
    } else if (shape.k === "hull") {
      trace(hullOf(points, shape.s * data.scale), true);
      paint(look, true);
    } else if (shape.k === "coil") {
      trace(coil(points[0], points[1], shape.s * data.scale), false);
      paint(look, false);
    } else if (shape.k === "arrow") {
      arrow(points[0], points[1], shape.s * data.scale);
      paint(look, false);
    } else if (shape.k === "curve") {
      smooth(points);
      paint(look, false);
    } else if (shape.k === "bow") {
      trace(bow(points[0], points[1], shape.s), false);
      paint(look, false);
    } else {
      trace(points, shape.k === "area");
      paint(look, shape.k === "area");
    }
  }

  function write(text, x, y, colour, size) {
    pen.font = size + "px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.setLineDash([]);
    pen.lineJoin = "round";
    pen.lineWidth = 2.6;
    pen.strokeStyle = tone("#FFFFFF");
    pen.strokeText(text, x, y);
    pen.fillStyle = tone(colour);
    pen.fillText(text, x, y);
  }

  function drawAxes(view) {
    const ways = data.axes.map(function (_, k) { return [view[0][k], -view[1][k]]; });
    const root = [data.margin + 8 - 20 * Math.min(0, ...ways.map(function (way) { return way[0]; })),
      data.height - 14 - 20 * Math.max(0, ...ways.map(function (way) { return way[1]; }))];
    data.axes.forEach(function (name, k) {
      const way = ways[k];
      pen.strokeStyle = tone("#6E6E6E");
      pen.lineWidth = 1;
      pen.setLineDash([]);
      trace([root, [root[0] + 20 * way[0], root[1] + 20 * way[1]]], false);
      pen.stroke();
      if (Math.hypot(way[0], way[1]) > 0.15) { write(name, root[0] + 27 * way[0], root[1] + 27 * way[1], "#6E6E6E", 8); }
    });
  }

  function drawRuler() {
    const right = data.width - data.margin, left = right - data.ruler[0] * data.scale, y = data.height - 18;
    pen.strokeStyle = tone("#6E6E6E");
    pen.lineWidth = 1;
    pen.setLineDash([]);
    for (const spots of [[[left, y], [right, y]], [[left, y - 3], [left, y + 3]], [[right, y - 3], [right, y + 3]]]) {
      trace(spots, false);
      pen.stroke();
    }
    write(data.ruler[1], right - 0.5 * pen.measureText(data.ruler[1]).width, y + 10, "#6E6E6E", 7);
  }

  /* How far two poses are apart. */
  function gap(a, b) {
    return Math.max(...[...a.turn, ...a.shift].map(function (x, k) { return Math.abs(x - [...b.turn, ...b.shift][k]); }));
  }

  function draw() {
    const ratio = (window.devicePixelRatio || 1) * Math.max(1, canvas.clientWidth / data.width);
    const wide = Math.round(data.width * ratio), high = Math.round(data.height * ratio);
    if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
    pen.setTransform(wide / data.width, 0, 0, high / data.height, 0, 0);
    pen.fillStyle = tone("#FFFFFF");
    pen.fillRect(0, 0, data.width, data.height);
    pen.lineJoin = "round";
    const here = poses(), view = rows(), clip = data.clips[state.clip];
    const parts = data.shapes.filter(function (shape) { return !state.off.has(shape.c); }).map(function (shape, order) {
      const points = shape.v.map(function (v) { return seen(v, here, view); });
      const near = points.reduce(function (sum, p) { return sum + p[2]; }, 0) / points.length;
      return { shape: shape, points: points, near: solid ? near : 0, layer: data.looks[shape.i][6], order: order };
    });
    parts.sort(function (a, b) { return a.layer - b.layer || a.near - b.near || a.order - b.order; });
    for (const part of parts) {
      const look = data.looks[part.shape.i], first = part.shape.v[0];
      const fresh = clip && clip.dropped && !state.free && gap(here[first[0]], still[first[0]]) > 1e-4;
      const round = part.shape.k === "ball";
      const red = ["#A31621", look[1] + 0.8, round ? [] : [7, 2, 1.5, 2], look[3] && "#A31621", round ? 1 : 0.2, false];
      if (part.shape.k !== "words") { drawShape(part.shape, part.points, fresh ? red : look); }
    }
    drawPaths(view);
    if (data.axes.length) { drawAxes(view); }
    if (data.ruler) { pen.font = "7px system-ui, sans-serif"; drawRuler(); }
    for (const part of parts) {
      if (part.shape.k !== "words") { continue; }
      const x = part.points.reduce(function (sum, p) { return sum + p[0]; }, 0) / part.points.length;
      const y = part.points.reduce(function (sum, p) { return sum + p[1]; }, 0) / part.points.length;
      write(part.shape.t, x + part.shape.o[0], y - part.shape.o[1], data.looks[part.shape.i][0], data.names);
    }
  }

  /* Controls */

  function make(tag, properties, ...children) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  }

  const box = document.querySelector(".controls"), said = document.getElementById("seen");
  const controls = {
    play: make("button", { type: "button", id: "play", textContent: "Play" }),
    slider: make("input", { type: "range", id: "slider", min: "0", step: "any", value: "0", ariaLabel: "position along the motion" }),
    clip: make("select", { id: "clip", ariaLabel: "motion" }),
    size: make("input", { type: "range", id: "size", min: "0", value: "0" }),
    speed: make("select", { id: "speed" }, new Option("0.5"), new Option("1", "1", true, true), new Option("2")),
    paths: make("input", { type: "checkbox", id: "paths" })
  };
  const sizing = make("label", {}, "size ", controls.size);
  const boxes = data.switches.map(function (item) {
    return make("input", { type: "checkbox", checked: true, value: item.name });
  });
  let way = 0, last = 0, rest = 0;

  /* The clips of a name, which differ by their size. */
  function sizes(name) { return data.clips.filter(function (clip) { return clip.name === name; }); }

  /* The phase of a motion there and back at which it is at a frame. */
  function wayTo(frame, count) { return Math.acos(1 - 2 * frame / Math.max(1, count - 1)); }

  function choose(clip) {
    Object.assign(state, { clip: data.clips.indexOf(clip), frame: clip.start, free: null });
    way = wayTo(clip.start, clip.frames.length);
    controls.slider.max = String(clip.frames.length - 1);
    controls.slider.value = String(clip.start);
    said.textContent = clip.text || "";
    draw();
  }

  function chooseName() {
    const group = sizes(controls.clip.value), chosen = group[group.length - 1];
    controls.size.max = String(group.length - 1);
    controls.size.value = controls.size.max;
    sizing.hidden = group.length < 2;
    data.switches.forEach(function (item, k) { if (!item.free) { boxes[k].checked = item.name !== chosen.dropped; } });
    state.off = new Set(boxes.filter(function (other) { return !other.checked; }).map(function (other) { return other.value; }));
    choose(chosen);
  }

  /* Redundant constraints can be off together; any other one only on its own. */
  function switchOff(item, input) {
    const on = boxes.filter(function (other, k) { return other !== input && !(item.free && data.switches[k].free); });
    if (!input.checked) { on.forEach(function (other) { other.checked = true; }); }
    const fresh = data.clips.find(function (clip) { return !input.checked && clip.dropped === item.name; });
    const now = data.clips[state.clip];
    state.off = new Set(boxes.filter(function (other) { return !other.checked; }).map(function (other) { return other.value; }));
    if (fresh || now && now.dropped && !state.off.has(now.dropped)) {
      controls.clip.value = (fresh || data.clips[0]).name;
      choose(fresh || data.clips[0]);
    }
    said.textContent = input.checked ? "" : item.text;
    draw();
  }

  /* So many frames of the clip further; a loop rests at its end. */
  function advance(frames) {
    const clip = data.clips[state.clip], count = clip.frames.length;
    if (clip.loop && state.frame === count - 1) {
      rest += frames;
      if (rest > 30) { rest = state.frame = 0; }
    } else if (clip.loop) {
      state.frame = Math.min(state.frame + frames, count - 1);
    } else if (clip.closed) {
      state.frame = (state.frame + frames) % count;
    } else {
      way = (way + frames * Math.PI / count) % (2 * Math.PI);  /* there and back, slowest at the ends */
      state.frame = (count - 1) * (1 - Math.cos(way)) / 2;
    }
    controls.slider.value = String(state.frame);
    draw();
  }

  function tick(time) {
    if (!state.playing) { return; }
    const pace = 40 * Math.max(1, 36 / data.clips[state.clip].frames.length), past = Math.min(Math.max(time - last, 0), 100);
    last = time;
    advance(past * Number(controls.speed.value) / pace);
    window.requestAnimationFrame(tick);
  }

  function setPlaying(on) {
    Object.assign(state, { playing: on, free: null });
    controls.play.textContent = on ? "Pause" : "Play";
    if (on) {
      way = wayTo(state.frame, data.clips[state.clip].frames.length);
      last = performance.now();
      window.requestAnimationFrame(tick);
    }
  }

  function setFrame() {
    setPlaying(false);
    state.frame = Number(controls.slider.value);
    draw();
  }

  if (data.clips.length) {
    box.hidden = false;
    const names = Array.from(new Set(data.clips.map(function (clip) { return clip.name; })));
    names.forEach(function (name) { controls.clip.add(new Option(name)); });
    controls.clip.hidden = names.length < 2;
    const pathing = make("label", { hidden: !data.traced.length || Boolean(data.clips[0].loop) }, controls.paths, " paths");
    box.append(controls.play, controls.slider, controls.clip, sizing, make("label", {}, "speed ", controls.speed), pathing);
    controls.paths.addEventListener("change", draw);
    controls.size.addEventListener("input", function () { choose(sizes(controls.clip.value)[Number(controls.size.value)]); });
    controls.play.addEventListener("click", function () { setPlaying(!state.playing); });
    controls.slider.addEventListener("input", setFrame);
    controls.clip.addEventListener("change", chooseName);
    if (boxes.length) {
      box.append(make("fieldset", { id: "switches" }, make("legend", { textContent: "constraints" }), ...boxes.map(function (input, k) {
        input.addEventListener("change", function () { switchOff(data.switches[k], input); });
        return make("label", {}, input, " " + input.value);
      })));
    }
    chooseName();
  }

  /* What the pointer and the arrow keys do: they turn a picture of space, and drag the points of one in the plane. */
  function takesPointer(start, move) {
    let from = null;
    canvas.tabIndex = 0;
    canvas.addEventListener("pointerdown", function (event) {
      from = start(event);
      if (from) { canvas.setPointerCapture(event.pointerId); }
    });
    canvas.addEventListener("pointermove", function (event) { if (from) { move(event, from); } });
    canvas.addEventListener("pointerup", function () { from = null; });
  }

  function takesArrows(act) {
    canvas.addEventListener("keydown", function (event) {
      const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (arrow) { event.preventDefault(); act(arrow); }
    });
  }

  function turned(azimuth, elevation) {
    Object.assign(state, { azimuth: azimuth, elevation: Math.max(-89, Math.min(89, elevation)) });
    draw();
  }

  const residual = make("span", { id: "residual", textContent: "Drag a point, or move it by the arrow keys (N takes the next point)." });

  function drag(grip, target) {
    const clip = data.clips[state.clip], from = state.free || (clip ? clip.frames[Math.floor(state.frame)] : program.start);
    setPlaying(false);
    const now = planar.pulled(from, grip, target, state.off);
    state.free = now.q;
    residual.textContent = "largest residual of a constraint " + now.here.worst.toExponential(0);
    canvas.dataset.residual = String(now.here.worst);
    draw();
  }

  /* A place of the world under the pointer. */
  function pointed(event) {
    const size = data.width / canvas.clientWidth;
    return [(event.offsetX * size - data.shift[0]) / data.scale + data.centre[0],
      (data.height - event.offsetY * size - data.shift[1]) / data.scale + data.centre[1]];
  }

  function placeOf(grip) { return moved(poses()[grip[0]], grip.slice(1)); }

  /* The point of a moving carrier that is nearest to a place: a vertex, or the place itself within a body. */
  function gripAt(place) {
    const here = poses(), view = rows(), spot = onPanel([...place, 0], view);
    let nearest = null, least = 18;
    for (const shape of data.shapes) {
      const points = shape.v.map(function (v) { return seen(v, here, view); }), carrier = shape.v[0][0];
      if (shape.k === "words" || !program.moves[carrier]) { continue; }
      trace(shape.k === "hull" ? hullOf(points, shape.s * data.scale) : points, true);
      const inside = (shape.k === "hull" || shape.k === "area") && pen.isPointInPath(spot[0], spot[1], "nonzero");
      points.forEach(function (p, k) {
        const far = Math.hypot(p[0] - spot[0], p[1] - spot[1]);
        if (program.moves[shape.v[k][0]] && far < least) { least = far; nearest = shape.v[k]; }
      });
      if (inside && least > 6) {
        const { turn, shift } = here[carrier], x = place[0] - shift[0], y = place[1] - shift[1];
        least = 6;
        nearest = [carrier, turn[0] * x + turn[3] * y, turn[1] * x + turn[4] * y, 0];
      }
    }
    return nearest;
  }

  if (solid) {
    canvas.classList.add("turns");
    takesPointer(function (event) { return [event.clientX, event.clientY, state.azimuth, state.elevation]; },
      function (event, from) { turned(from[2] - 0.5 * (event.clientX - from[0]), from[3] + 0.5 * (event.clientY - from[1])); });
    takesArrows(function (arrow) { turned(state.azimuth - 5 * arrow[0], state.elevation + 5 * arrow[1]); });
  } else if (program && program.drag) {
    let grip = data.traced[0];
    canvas.classList.add("turns");
    box.hidden = false;
    box.append(residual);
    takesPointer(function (event) { return gripAt(pointed(event)); }, function (event, from) { grip = from; drag(from, pointed(event)); });
    takesArrows(function (arrow) {
      const place = placeOf(grip);
      drag(grip, [place[0] + 6 * arrow[0] / data.scale, place[1] + 6 * arrow[1] / data.scale]);
    });
    canvas.addEventListener("keydown", function (event) {
      if (event.key === "n") { grip = data.traced[(data.traced.indexOf(grip) + 1) % data.traced.length]; }
    });
  }
  window.addEventListener("resize", draw);
  night.addEventListener("change", function () { hatch = makeHatch(); draw(); });
  /* The picture that stood here before this script ran makes room for the canvas. */
  const first = document.getElementById("first");
  if (first) { first.remove(); }
  canvas.hidden = false;
  draw();
  canvas.dataset.opened = String(performance.now() - opened);
})();
