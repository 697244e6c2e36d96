/* dofkit's player: draws a sketch on a canvas, plays its motions, and turns it where it is of space.
   Part of dofkit, under its MIT licence; it uses no other library and fetches nothing. */
"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const canvas = document.querySelector("canvas");
  const pen = canvas.getContext("2d");
  const solid = data.dimension === 3;
  const state = { clip: 0, frame: 0, playing: false, azimuth: data.view[0], elevation: data.view[1] };
  const night = window.matchMedia("(prefers-color-scheme: dark)");
  let hatch = makeHatch();

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

  function moved(pose, p) {
    if (pose.length === 3) { return [p[0] + pose[0], p[1] + pose[1], p[2] + pose[2]]; }
    if (pose.length === 5) {
      const c = pose[3], s = pose[4];
      return [c * p[0] - s * p[1] + pose[0], s * p[0] + c * p[1] + pose[1], p[2] + pose[2]];
    }
    return [dot(pose.slice(3, 6), p) + pose[0], dot(pose.slice(6, 9), p) + pose[1], dot(pose.slice(9, 12), p) + pose[2]];
  }

  function poses() {
    const clip = data.clips[state.clip];
    return clip ? clip.frames[state.frame] : data.still;
  }

  /* A vertex on the panel: to the right, down, and how near. */
  function seen(vertex, here, view) {
    const p = moved(here[vertex[0]], [vertex[1], vertex[2], vertex[3]]);
    const q = [p[0] - data.centre[0], p[1] - data.centre[1], p[2] - data.centre[2]];
    return [data.shift[0] + data.scale * dot(view[0], q),
      data.height - data.shift[1] - data.scale * dot(view[1], q), dot(view[2], q)];
  }

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

  /* Paths of vertices: of a loop as far as it has gone, with the displacement at its end as an arrow. */
  function drawPaths(view) {
    const clip = data.clips[state.clip];
    if (!clip || !(paths.checked || clip.loop)) { return; }
    const until = clip.loop ? state.frame + 1 : clip.frames.length;
    for (const vertex of data.traced) {
      const path = clip.frames.slice(0, until).map(function (here) { return seen(vertex, here, view); });
      trace(path, false);
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

  function drawShape(shape, points) {
    const look = data.looks[shape.i];
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
    const root = [data.margin + 26, data.height - data.margin - 22];
    data.axes.forEach(function (name, k) {
      const way = [view[0][k], -view[1][k]];
      pen.strokeStyle = tone("#6E6E6E");
      pen.lineWidth = 1;
      pen.setLineDash([]);
      trace([root, [root[0] + 18 * way[0], root[1] + 18 * way[1]]], false);
      pen.stroke();
      if (Math.hypot(way[0], way[1]) > 0.15) { write(name, root[0] + 25 * way[0], root[1] + 25 * way[1], "#6E6E6E", 8); }
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

  function draw() {
    const ratio = (window.devicePixelRatio || 1) * Math.max(1, canvas.clientWidth / data.width);
    const wide = Math.round(data.width * ratio), high = Math.round(data.height * ratio);
    if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
    pen.setTransform(wide / data.width, 0, 0, high / data.height, 0, 0);
    pen.fillStyle = tone("#FFFFFF");
    pen.fillRect(0, 0, data.width, data.height);
    pen.lineJoin = "round";
    const here = poses(), view = rows();
    const parts = data.shapes.map(function (shape, order) {
      const points = shape.v.map(function (v) { return seen(v, here, view); });
      const near = points.reduce(function (sum, p) { return sum + p[2]; }, 0) / points.length;
      return { shape: shape, points: points, near: solid ? near : 0, layer: data.looks[shape.i][6], order: order };
    });
    parts.sort(function (a, b) { return a.layer - b.layer || a.near - b.near || a.order - b.order; });
    for (const part of parts) { if (part.shape.k !== "words") { drawShape(part.shape, part.points); } }
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

  const play = document.getElementById("play"), slider = document.getElementById("slider");
  const chooser = document.getElementById("clip"), size = document.getElementById("size");
  const paths = document.getElementById("paths"), speed = document.getElementById("speed");
  const names = Array.from(new Set(data.clips.map(function (clip) { return clip.name; })));
  let way = 1, last = 0, rest = 0;

  /* The clips of a name, which differ by their size. */
  function sizes(name) { return data.clips.filter(function (clip) { return clip.name === name; }); }

  function choose(clip) {
    state.clip = data.clips.indexOf(clip);
    state.frame = 0;
    way = 1;
    slider.max = String(clip.frames.length - 1);
    slider.value = "0";
    document.getElementById("seen").textContent = clip.text || "";
    draw();
  }

  function chooseName() {
    const group = sizes(chooser.value);
    size.max = String(group.length - 1);
    size.value = size.max;
    document.getElementById("sizing").hidden = group.length < 2;
    choose(group[group.length - 1]);
  }

  function advance() {
    const clip = data.clips[state.clip], count = clip.frames.length;
    if (clip.loop && state.frame === count - 1) {
      rest = (rest + 1) % 30;
      if (!rest) { state.frame = 0; }
    } else if (clip.closed || clip.loop) {
      state.frame = (state.frame + 1) % count;
    } else if (count > 1) {
      if (state.frame + way < 0 || state.frame + way >= count) { way = -way; }
      state.frame += way;
    }
    slider.value = String(state.frame);
    draw();
  }

  function tick(time) {
    if (!state.playing) { return; }
    if (time - last > 40 / Number(speed.value)) { last = time; advance(); }
    window.requestAnimationFrame(tick);
  }

  function setPlaying(on) {
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    if (on) { window.requestAnimationFrame(tick); }
  }

  if (data.clips.length) {
    document.querySelector(".controls").hidden = false;
    names.forEach(function (name) { chooser.add(new Option(name)); });
    chooser.hidden = names.length < 2;
    document.getElementById("pathing").hidden = !data.traced.length || Boolean(data.clips[0].loop);
    paths.addEventListener("change", draw);
    size.addEventListener("input", function () { choose(sizes(chooser.value)[Number(size.value)]); });
    play.addEventListener("click", function () { setPlaying(!state.playing); });
    slider.addEventListener("input", function () { setPlaying(false); state.frame = Number(slider.value); draw(); });
    chooser.addEventListener("change", chooseName);
    chooseName();
  }

  if (solid) {
    canvas.classList.add("turns");
    canvas.tabIndex = 0;
    let from = null;
    canvas.addEventListener("pointerdown", function (event) {
      from = [event.clientX, event.clientY, state.azimuth, state.elevation];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", function (event) {
      if (!from) { return; }
      state.azimuth = from[2] - 0.5 * (event.clientX - from[0]);
      state.elevation = Math.max(-89, Math.min(89, from[3] + 0.5 * (event.clientY - from[1])));
      draw();
    });
    canvas.addEventListener("pointerup", function () { from = null; });
    canvas.addEventListener("keydown", function (event) {
      const turn = { ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
      if (!turn) { return; }
      event.preventDefault();
      state.azimuth += turn[0];
      state.elevation = Math.max(-89, Math.min(89, state.elevation + turn[1]));
      draw();
    });
  }
  window.addEventListener("resize", draw);
  night.addEventListener("change", function () { hatch = makeHatch(); draw(); });
  draw();
})();
