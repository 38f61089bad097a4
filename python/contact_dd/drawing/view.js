// Draws what view.py packs: bodies by a field, deformed, to be turned and zoomed. Where that can't be, the picture stays.
(async () => {
  const box = document.getElementById("view"), live = box.querySelector(".live");
  const canvas = live.querySelector("canvas"), gl = canvas.getContext("webgl2", { alpha: false, preserveDrawingBuffer: true });
  if (!gl || typeof DecompressionStream === "undefined") return;
  const about = JSON.parse(box.querySelector("script").textContent);
  const packed = Uint8Array.from(atob(box.querySelectorAll("script")[1].textContent), c => c.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(unpacked).arrayBuffer();
  const arrays = { "<f4": Float32Array, "<u4": Uint32Array, "<u2": Uint16Array, "<u1": Uint8Array };
  const numbers = place => new arrays[place.kind](bytes, place.at, place.length);

  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, `#version 300 es
    layout(location = 0) in vec3 point;
    layout(location = 1) in vec3 displacement;
    layout(location = 2) in float value;
    uniform mat4 camera;
    uniform float scale, nearer;
    out vec3 at;
    out float share;
    void main() {
      at = point + scale * displacement;
      share = value;
      gl_Position = camera * vec4(at, 1) - vec4(0, 0, nearer, 0);
    }`], [gl.FRAGMENT_SHADER, `#version 300 es
    precision highp float;
    in vec3 at;
    in float share;
    uniform sampler2D colours;
    uniform vec3 eye;
    uniform vec4 plain;  // as it is where it's opaque at all
    uniform bool shaded;
    out vec4 colour;
    void main() {
      vec4 own = plain.a > 0. ? plain : texture(colours, vec2((share * 255. + .5) / 256., .5));
      vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
      colour = vec4(own.rgb * (shaded ? .6 + .4 * abs(dot(normal, eye)) : 1.), own.a);
    }`]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return;
  gl.useProgram(program);
  const uniform = Object.fromEntries(["camera", "scale", "eye", "plain", "shaded", "nearer"]
    .map(name => [name, gl.getUniformLocation(program, name)]));

  const buffer = (values, target = gl.ARRAY_BUFFER) => {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return made;
  };
  const known = {};
  const attribute = (where, place, width, kind) => {
    if (known[place.at]) gl.bindBuffer(gl.ARRAY_BUFFER, known[place.at]);
    else known[place.at] = buffer(numbers(place));
    gl.enableVertexAttribArray(where);
    gl.vertexAttribPointer(where, width, kind, kind !== gl.FLOAT, 0, 0);
  };
  const indices = place => place && { count: place.length, of: buffer(numbers(place), gl.ELEMENT_ARRAY_BUFFER) };
  const points = numbers(about.points), nodes = numbers(about.nodes);
  // Parts that are active in the same steps: their surfaces, and flags of their nodes.
  const surfaces = about.surfaces.map(({ triangles, edges, sides }) => {
    const has = new Uint8Array(nodes.length);
    numbers(triangles).forEach(node => has[node] = 1);
    return { faces: indices(triangles), edges: indices(edges), sides: indices(sides), has };
  });
  attribute(0, about.points, 3, gl.FLOAT);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.clearColor(1, 1, 1, 1);

  const input = name => live.querySelector(`[name=${name}]`);
  const round = number => Number(number.toPrecision(3)).toString();
  let step, field, faces, edges, sides, has, displacements, values, camera, eye, across, up;
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const add = (a, factor, b) => a.map((one, k) => one + factor * b[k]);
  // Half of the height of the canvas, in lengths of the model.
  const half = () => 1.06 / camera.zoom * Math.max(camera.size[1], camera.size[0] * canvas.height / canvas.width);
  const factor = () => about.scale * input("scale").value;

  // Looks at the whole.
  function start() {
    camera = about.turns ? { azimuth: about.azimuth, elevation: about.elevation } : { azimuth: -90, elevation: 90 };
    camera.zoom = 1;
    look();
    const low = [Infinity, Infinity, Infinity], high = low.map(one => -one);
    for (let k = 0; k < nodes.length; k++) {
      const at = place(k);
      for (const [c, way] of [across, up, eye].entries()) {
        low[c] = Math.min(low[c], dot(at, way));
        high[c] = Math.max(high[c], dot(at, way));
      }
    }
    const middle = low.map((one, c) => (one + high[c]) / 2);
    camera.size = high.map((one, c) => one - middle[c]);
    camera.middle = add(add(add([0, 0, 0], middle[0], across), middle[1], up), middle[2], eye);
  }
  // Where a node is, deformed.
  const place = k => [0, 1, 2].map(c => points[3 * k + c] + factor() * displacements[3 * k + c]);
  function look() {
    const [a, e] = [camera.azimuth, camera.elevation].map(angle => angle * Math.PI / 180);
    eye = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    across = [-Math.sin(a), Math.cos(a), 0];
    up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
  }

  function choose() {
    step = about.steps[input("step").selectedIndex];
    field = step.fields[input("field").selectedIndex];
    ({ faces, edges, sides, has } = surfaces[step.surface]);
    displacements = numbers(step.displacements);
    values = numbers(field.values);
    attribute(1, step.displacements, 3, gl.FLOAT);
    attribute(2, field.values, 1, gl.UNSIGNED_SHORT);
    const map = numbers(about.maps[field.map]);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, map);
    const stops = [...Array(17).keys()].map(k => 4 * Math.round(k * 255 / 16));
    live.querySelector(".bar i").style.background =
      `linear-gradient(to right, ${stops.map(k => `rgb(${map[k]} ${map[k + 1]} ${map[k + 2]})`)})`;
    input("low").textContent = "0";
    const above = field.largest > 1.001 * field.most ? `, largest ${round(field.largest)}` : "";
    input("high").textContent = `${round(field.most)} ${field.unit}${above}`;
    if (!camera) start();
    draw();
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    look();
    // Columns of the matrix; depths are those of a box four times as large as the bodies.
    const rows = [[across, half() * canvas.width / canvas.height], [up, half()], [eye, -4]];
    const column = k => [...rows.map(([way, size]) => way[k] / size), 0];
    const last = [...rows.map(([way, size]) => -dot(way, camera.middle) / size), 1];
    gl.uniformMatrix4fv(uniform.camera, false, [...column(0), ...column(1), ...column(2), ...last]);
    gl.uniform1f(uniform.scale, factor());
    gl.uniform3fv(uniform.eye, eye);
    const through = sides && field.name === "contact pressure";
    const render = (what, mode, plain, shaded) => {
      gl.uniform4fv(uniform.plain, plain);
      gl.uniform1i(uniform.shaded, shaded);
      // Lines aren't hidden by the faces that they bound.
      gl.uniform1f(uniform.nearer, mode === gl.LINES ? 3e-4 : 0);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, what.of);
      gl.drawElements(mode, what.count, gl.UNSIGNED_INT, 0);
    };
    render(through ? sides : faces, gl.TRIANGLES, [0, 0, 0, 0], about.turns);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    if (through) {
      gl.disable(gl.DEPTH_TEST);
      render(faces, gl.TRIANGLES, [0.45, 0.5, 0.55, 0.08], true);
      gl.enable(gl.DEPTH_TEST);
    }
    if (input("edges").checked) render(edges, gl.LINES, [0, 0, 0, through ? 0.06 : 0.22], false);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    input("scale").nextElementSibling.textContent = `× ${round(factor())}`;
    canvas.dataset.drawn = (through ? sides : faces).count / 3;
  }

  // The node that is seen nearest to a place on the canvas, with its value.
  function tell(x, y) {
    const seen = half() / (canvas.clientHeight / 2);
    let best = -1, depth = -Infinity;
    for (let k = 0; k < nodes.length; k++) {
      if (!has[k]) continue;
      const at = add(place(k), -1, camera.middle);
      const near = Math.hypot(dot(at, across) / seen - x + canvas.clientWidth / 2,
        canvas.clientHeight / 2 - dot(at, up) / seen - y);
      const towards = dot(at, eye) - near * seen;
      if (near < 12 && towards > depth) [best, depth] = [k, towards];
    }
    const where = [0, 1, 2].slice(0, about.turns ? 3 : 2)
      .map(c => round(points[3 * best + c] * about.size + about.center[c])).join(", ");
    const clipped = values[best] === 65535 ? " or more" : "";
    input("here").textContent = best < 0 ? "" : `node ${nodes[best]} at (${where}) ${about.length}: ` +
      `${round(values[best] / 65535 * field.most)} ${field.unit}${clipped}`;
  }

  function turn(right, down) {
    camera.azimuth -= right;
    camera.elevation = Math.max(-90, Math.min(90, camera.elevation + down));
  }
  function move(right, down) {
    const seen = half() / (canvas.clientHeight / 2);
    camera.middle = add(add(camera.middle, -right * seen, across), down * seen, up);
  }
  // Makes it larger; what is at the place stays there.
  function zoom(by, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) {
    const [right, down] = [canvas.clientWidth / 2 - x, canvas.clientHeight / 2 - y];
    move(right, down);
    camera.zoom *= by;
    move(-right, -down);
  }

  const held = new Map();
  canvas.onpointerdown = event => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.offsetX, event.offsetY]);
  };
  canvas.onpointerup = canvas.onpointercancel = event => held.delete(event.pointerId);
  canvas.onpointermove = event => {
    const before = held.get(event.pointerId), now = [event.offsetX, event.offsetY];
    if (!before) return tell(...now);
    held.set(event.pointerId, now);
    const way = [now[0] - before[0], now[1] - before[1]];
    if (held.size === 2) {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const apart = from => Math.hypot(from[0] - other[0], from[1] - other[1]);
      zoom(apart(now) / Math.max(apart(before), 1), ...other);
    } else if (about.turns && !event.shiftKey) turn(way[0] / 3, way[1] / 3);
    else move(...way);
    draw();
  };
  canvas.onwheel = event => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
    draw();
  };
  canvas.ondblclick = () => {
    start();
    draw();
  };
  canvas.onkeydown = event => {
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const way = ways[event.key], by = { "+": 1.25, "-": 0.8 }[event.key];
    if (way && about.turns && !event.shiftKey) turn(...way.map(one => 5 * one));
    else if (way) move(...way.map(one => -30 * one));
    else if (by) zoom(by);
    else return;
    event.preventDefault();
    draw();
  };
  input("step").selectedIndex = about.steps.length - 1;
  input("step").onchange = input("field").onchange = choose;
  input("scale").oninput = input("edges").onchange = draw;
  box.classList.add("drawn");
  live.hidden = false;
  new ResizeObserver(draw).observe(canvas);
  choose();
})();
