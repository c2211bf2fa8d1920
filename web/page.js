// The page: what its controls say to the library, and what the library says to them. The scene itself
// is the library's; a control changes one thing in it and sends it back.

const $ = (id) => document.getElementById(id);
const canvas = $('canvas');

// The worker -------------------------------------------------------------------------------------

const waiting = new Map();
let next_id = 0;
const make_worker = () => new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
const worker = make_worker();
// Built-in environments are drawn in another thread, as that takes seconds.
let painter;

// Resolves to the answer; one with an `error` is shown and thrown.
function ask_of(one, call, args, transfer = []) {
  const id = ++next_id;
  one.postMessage({ id, call, args }, transfer);
  return new Promise((resolve, reject) => waiting.set(id, { resolve, reject }));
}
const ask = (call, args = [], transfer = []) => ask_of(worker, call, args, transfer);

worker.onerror = (event) => {
  ready_text = 'Stopped.';
  show_stage('');
  show_error(event.message || 'The page’s files could not be loaded.');
};
const on_message = ({ data }) => {
  if (data.id) {
    const { resolve, reject } = waiting.get(data.id);
    waiting.delete(data.id);
    if (data.result.error) {
      show_error(data.result.error);
      reject(new Error(data.result.error));
    } else {
      resolve(data.result);
    }
  }
  if (data.stage !== undefined) show_stage(data.stage);
  if (data.frame) on_frame(data.frame);
  if (data.failure) show_error(data.failure);
  for (const map of data.maps ?? []) show_map(map);
};
worker.onmessage = on_message;

// Changes go one after the other; while one is on its way only the newest of a kind waits.
const newest = new Map();
async function ask_newest(kind, make) {
  const before = newest.get(kind);
  newest.set(kind, make);
  if (before !== undefined) return;
  try {
    while (newest.get(kind)) {
      const run = newest.get(kind);
      newest.set(kind, null);
      await run();
    }
  } catch { /* it is on the page */ } finally {
    newest.delete(kind);
  }
}

// Messages ---------------------------------------------------------------------------------------

let ready_text = '';

function show_stage(text) {
  document.body.classList.toggle('busy', text !== '');
  $('status').textContent = text || ready_text;
}

function show_error(text) {
  $('error').textContent = text;
  $('error').hidden = !text;
}

function on_frame(frame) {
  if (frame.error) return show_error(frame.error);
  $('frame-time').textContent = `${frame.milliseconds.toFixed(0)} ms`;
  if (frame.changed) document.body.dataset.changes = frame.count;
  document.body.dataset.smooth = frame.smooth;
}

// What is shown ----------------------------------------------------------------------------------

let facts, status;
// What the library leaves out of a scene, because it is so unless it is said.
const kMaterial = { base_color: 1, mirror: 1, glossy: 0, diffuse: 0, transmission: 0,
  lobe: 'ggx:0.3', fresnel: '', coupling: 'layered', index: 1.5 };

const scene = () => status.scene;
const environment = () => (status.scene.environment ??= {});
const object = () => status.scene.objects?.[status.selected];
const material = () => ({ ...kMaterial, ...object()?.material });
const is_file = (name) => !name.startsWith('builtin:');
const base_name = (path) => path.split('/').pop();

async function refresh() {
  status = await ask('status');
  show_controls();
  remember();
}

function change_scene(change) {
  change(status.scene);
  ask_newest('scene', async () => {
    try {
      await ask('set_scene', [status.scene]);
      show_error('');
    } finally {
      if (!newest.get('scene')) await refresh();
    }
  });
}

function change_material(change) {
  change_scene((scene) => {
    scene.objects ??= [{}];
    const one = scene.objects[status.selected];
    one.material = { ...one.material, ...change };
  });
}

// The state in the address -----------------------------------------------------------------------

let remembering = 0, own_hash = '';

// Files that were opened are not in a link: in their place stands what is usual.
function linkable(state) {
  const at = state.indexOf('scene=') + 'scene='.length;
  const scene = JSON.parse(state.slice(at));
  if (is_file(scene.environment?.source ?? 'builtin:')) delete scene.environment.source;
  const known = new Set(facts.meshes.map((mesh) => mesh.name));
  for (const object of scene.objects ?? [])
    if (object.mesh && !known.has(object.mesh)) object.mesh = 'sphere';
  return state.slice(0, at) + JSON.stringify(scene);
}

function remember() {
  clearTimeout(remembering);
  remembering = setTimeout(async () => {
    const { state } = await ask('status');
    own_hash = '#' + encodeURI(linkable(state));
    history.replaceState(null, '', own_hash);
  }, 250);
}

function state_of_address() {
  try {
    return decodeURI(location.hash.slice(1));
  } catch {
    return location.hash.slice(1);
  }
}

window.addEventListener('hashchange', async () => {
  if (location.hash === own_hash) return;
  await ask('set_state', [state_of_address()]).then(() => show_error(''), () => {});
  await refresh();
});

// Controls ---------------------------------------------------------------------------------------

function options(select, entries) {
  select.replaceChildren(...entries.map(({ value, text, title }) => {
    const option = new Option(text, value);
    if (title) option.title = title;
    return option;
  }));
}
const by_name = (entries) =>
  entries.map((entry) => ({ value: entry.name, text: entry.name, title: entry.description }));

// A choice that is not on the list (a file, numbers of one's own) gets a place at its end.
function choose(select, value, text = value) {
  for (const option of [...select.options]) if (option.dataset.own) option.remove();
  if (![...select.options].some((option) => option.value === value)) {
    const option = new Option(text, value);
    option.dataset.own = 'yes';
    select.add(option);
  }
  select.value = value;
}

function show_range(input, value, text) {
  if (document.activeElement !== input || !input.matches(':active')) input.value = value;
  const shown = text ?? String(+(+value).toFixed(2)) + (input.dataset.unit ?? '');
  input.closest('label').querySelector('output').textContent = shown;
  input.setAttribute('aria-valuetext', shown);
}

const split_lobe = (lobe) => {
  const [kind, number] = lobe.split(':');
  return { kind, parameter: Number(number ?? 0) };
};
// Exponents from 1 to 100 000 on a slider from 0 to 1, evenly by their logarithm.
const is_exponent = (kind) => kind === 'phong' || kind === 'blinn-phong';
const kMostDecades = 5;
const to_slider = ({ kind, parameter }) =>
  is_exponent(kind) ? Math.log10(Math.max(1, parameter)) / kMostDecades : parameter;
const from_slider = (kind, value) => {
  if (is_exponent(kind)) return Number((10 ** (kMostDecades * value)).toPrecision(4));
  return kind === 'charlie' ? Math.max(0.01, value) : value;
};

const encode = (linear) => linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
const decode = (code) => code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4;
const as_rgb = (colour) => Array.isArray(colour) ? colour : [colour, colour, colour];
const to_hex = (colour) => '#' + as_rgb(colour).map((value) =>
  Math.round(255 * encode(Math.min(1, Math.max(0, value)))).toString(16).padStart(2, '0')).join('');
const from_hex = (hex) =>
  [1, 3, 5].map((at) => Number(decode(parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(5)));

function show_controls() {
  const light = environment();
  const source = light.source ?? 'builtin:sunset';
  choose($('environment'), source, base_name(source));
  show_range($('turn'), light.yaw_degrees ?? 0);
  show_range($('stops'), status.stops);
  choose($('tone-map'), scene().tone_map ?? 'film');
  $('background').checked = light.background ?? true;

  const mesh = object()?.mesh ?? 'sphere';
  choose($('mesh'), mesh, base_name(mesh));

  const method = scene().method ?? 'cube';
  choose($('method'), method);
  $('method-description').textContent =
    facts.methods.find((one) => one.name === method)?.description ?? '';
  $('showing').value = status.showing;
  choose($('other'), status.other);
  show_range($('wipe'), status.wipe);
  show_range($('full-scale'), Math.log10(status.full_scale),
    `${+(status.full_scale * 255).toFixed(1)} of 255`);
  for (const [name, when] of [['comparing', status.showing !== 'one'],
    ['wiping', status.showing === 'wipe'], ['differing', status.showing === 'difference']])
    document.querySelector(`.${name}`).hidden = !when;
  $('wipe-line').hidden = status.showing !== 'wipe';
  $('wipe-line').style.left = `${100 * status.wipe}%`;

  const m = material();
  for (const weight of ['mirror', 'glossy', 'diffuse', 'transmission'])
    show_range($(weight), m[weight]);
  const lobe = split_lobe(m.lobe);
  choose($('lobe-kind'), lobe.kind);
  $('lobe-word').textContent = is_exponent(lobe.kind) ? 'Exponent' : 'Roughness';
  show_range($('lobe-parameter'), to_slider(lobe), String(+lobe.parameter.toPrecision(4)));
  show_fresnel(m);
  choose($('coupling'), m.coupling);
  $('base-color').value = to_hex(m.base_color);
  show_bump(m);
  show_lights();
  ready_text = `${base_name(source)}: ${status.notes.join('; ')}`;
  if (!document.body.classList.contains('busy')) show_stage('');
}

// "" is all light at every angle; "index=1.5"; "metal=gold"; the rest is someone's own.
function show_fresnel(m) {
  const kind = m.fresnel.startsWith('index=') ? 'index' : m.fresnel;
  choose($('fresnel'), kind);
  const index = kind === 'index' ? Number.parseFloat(m.fresnel.slice('index='.length)) : m.index;
  show_range($('index'), index);
  $('index').disabled = kind !== 'index' && m.transmission === 0;
}

function change_index(value) {
  const index = Number(value);
  const change = { index };
  if ($('fresnel').value === 'index') change.fresnel = `index=${index}`;
  change_material(change);
}

// Of builds whose materials have relief.
function show_bump(m) {
  if (!facts.bumps) return;
  $('bump-controls').hidden = false;
  choose($('bump-source'), m.bump?.source ?? '');
  show_range($('bump-strength'), m.bump?.strength ?? 1);
}

// Lights: a sun's direction by azimuth and height ------------------------------------------------

function show_lights() {
  const list = scene().lights ?? [];
  const shown = list.map((light, i) => {
    const box = document.createElement('div');
    box.className = 'light';
    const sun = light.directional;
    const title = document.createElement('strong');
    title.textContent = `${sun ? 'Sun' : 'Lamp'} ${i + 1}`;
    box.append(title);
    const [x, y, z] = sun ? (sun.direction ?? [0, 1, 0]) : (light.point?.position ?? [0, 3, 0]);
    const length = Math.hypot(x, y, z) || 1;
    const azimuth = Math.atan2(x, z) * 180 / Math.PI, height = Math.asin(y / length) * 180 / Math.PI;
    const strength = sun ? as_rgb(sun.normal_irradiance ?? 1) : as_rgb(light.point?.intensity ?? 10);
    const brightest = Math.max(...strength, 1e-6);
    const at = (azimuth, height, stops, colour) => {
      const [a, h] = [azimuth * Math.PI / 180, height * Math.PI / 180];
      const direction = [Math.cos(h) * Math.sin(a), Math.sin(h), Math.cos(h) * Math.cos(a)];
      const scaled = colour.map((value) => value * 2 ** stops);
      return sun ? { directional: { direction, normal_irradiance: scaled } }
        : { point: { position: direction.map((value) => value * length), intensity: scaled } };
    };
    const colour = strength.map((value) => value / brightest);
    const inputs = {};
    const apply = () => change_scene((scene) => {
      scene.lights[i] = at(Number(inputs.azimuth.value), Number(inputs.height.value),
        Number(inputs.stops.value), from_hex(inputs.colour.value));
    });
    const slider = (key, text, min, max, step, value, unit) => {
      const label = document.createElement('label');
      const output = document.createElement('output');
      const input = Object.assign(document.createElement('input'),
        { type: 'range', min, max, step, value });
      input.dataset.unit = unit;
      label.append(text, output, input);
      inputs[key] = input;
      input.addEventListener('input', () => { show_range(input, input.value); apply(); });
      box.append(label);
      show_range(input, value);
    };
    slider('azimuth', 'Around', -180, 180, 1, azimuth, '°');
    slider('height', 'Above', -90, 90, 1, height, '°');
    slider('stops', 'Brightness', -8, 12, 0.1, Math.log2(brightest), ' stops');
    const label = document.createElement('label');
    inputs.colour = Object.assign(document.createElement('input'),
      { type: 'color', value: to_hex(colour) });
    inputs.colour.addEventListener('input', apply);
    label.append('Colour ', inputs.colour);
    const remove = Object.assign(document.createElement('button'),
      { type: 'button', textContent: 'Remove' });
    remove.setAttribute('aria-label', `Remove light ${i + 1}`);
    remove.addEventListener('click', () => change_scene((scene) => scene.lights.splice(i, 1)));
    box.append(label, remove);
    return box;
  });
  // Whoever drags a light's slider keeps it.
  if (shown.length === $('lights').children.length && $('lights').contains(document.activeElement))
    return;
  $('lights').replaceChildren(...shown);
}

// Wiring -----------------------------------------------------------------------------------------

function wire_controls() {
  const on = (id, event, act) => $(id).addEventListener(event, () => act($(id).value));
  const material_number = (id) => on(id, 'input', (value) => {
    show_range($(id), value);
    change_material({ [id]: Number(value) });
  });
  on('environment', 'change', (source) => paint_environment(source));
  on('turn', 'input', (degrees) => {
    show_range($('turn'), degrees);
    change_scene((scene) => {
      scene.environment = { ...scene.environment, yaw_degrees: Number(degrees) };
    });
  });
  on('stops', 'input', (stops) => {
    show_range($('stops'), stops);
    ask_newest('stops', async () => {
      await ask('set_stops', [Number(stops)]);
      await refresh();
    });
  });
  on('tone-map', 'change', (name) => change_scene((scene) => { scene.tone_map = name; }));
  $('background').addEventListener('change', () => change_scene((scene) => {
    scene.environment = { ...scene.environment, background: $('background').checked };
  }));
  on('mesh', 'change', (mesh) => change_scene((scene) => {
    scene.objects ??= [{}];
    scene.objects[status.selected].mesh = mesh;
  }));
  on('method', 'change', (method) => busy_change((scene) => { scene.method = method; }));
  const compare = () => ask_newest('comparison', async () => {
    await ask('set_comparison', [$('showing').value, $('other').value, Number($('wipe').value),
      10 ** Number($('full-scale').value)]);
    await refresh();
  });
  for (const id of ['showing', 'other']) on(id, 'change', compare);
  for (const id of ['wipe', 'full-scale']) on(id, 'input', compare);

  on('preset', 'change', (name) => {
    if (name) change_scene((scene) => { scene.objects[status.selected].material = name; });
    $('preset').value = '';
  });
  for (const id of ['mirror', 'glossy', 'diffuse', 'transmission']) material_number(id);
  on('lobe-kind', 'change', (kind) => {
    const usual = { ggx: 0.3, charlie: 0.5, phong: 100, 'blinn-phong': 400 }[kind];
    change_material({ lobe: `${kind}:${usual}` });
  });
  on('lobe-parameter', 'input', (value) => {
    const kind = $('lobe-kind').value;
    const parameter = from_slider(kind, Number(value));
    show_range($('lobe-parameter'), value, String(parameter));
    change_material({ lobe: `${kind}:${parameter}` });
  });
  on('fresnel', 'change', (kind) =>
    change_material({ fresnel: kind === 'index' ? `index=${$('index').value}` : kind }));
  on('index', 'input', (value) => { show_range($('index'), value); change_index(value); });
  on('coupling', 'change', (coupling) => change_material({ coupling }));
  on('base-color', 'input', (hex) => change_material({ base_color: from_hex(hex) }));
  const change_bump = () => change_material({ bump: $('bump-source').value === '' ? undefined
    : { source: $('bump-source').value, strength: Number($('bump-strength').value) } });
  on('bump-source', 'change', change_bump);
  on('bump-strength', 'input', (value) => { show_range($('bump-strength'), value); change_bump(); });

  $('add-light').addEventListener('click', () => change_scene((scene) => {
    (scene.lights ??= []).push({ directional: { direction: [0.5, 0.7, 0.5], normal_irradiance: 3 } });
  }));
  $('screenshot').addEventListener('click', async () => {
    const { blob } = await ask('screenshot');
    save(blob, 'mirrorball.png');
  });
  $('save-scene').addEventListener('click', () =>
    save(new Blob([JSON.stringify(scene(), null, 2) + '\n'], { type: 'application/json' }),
      'scene.json'));
  $('copy-link').addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(location.href);
      $('status').textContent = 'The link is copied.';
    } catch {
      $('status').textContent = 'Copy the address from the browser’s bar.';
    }
  });
  $('frame').addEventListener('click', () => ask('frame_all', [aspect()]).then(remember));
  on('map-content', 'change', show_maps);
  for (const id of ['environment-file', 'mesh-file'])
    $(id).addEventListener('change', () => {
      if ($(id).files.length) open_files($(id).files);
      $(id).value = '';
    });
  $('controls').addEventListener('submit', (event) => event.preventDefault());
}

// A built-in environment, drawn elsewhere, and then in place of what is shown: if nobody has chosen
// another one meanwhile.
let painting = '';
async function paint_environment(source) {
  painting = source;
  show_stage(`Drawing ${base_name(source)} …`);
  if (!painter) {
    painter = make_worker();
    painter.onmessage = on_message;
  }
  try {
    const map = await ask_of(painter, 'builtin', [source]);
    if (painting !== source) return;
    await ask('take_builtin', [source, map], [map.values.buffer]);
    painting = '';
    document.body.dataset.painted = source;
    show_error('');
  } catch { /* it is on the page */ }
  await refresh();
  show_stage('');
}

// Of what may take a while.
function busy_change(change) {
  show_stage('Prefiltering …');
  change(status.scene);
  ask('set_scene', [status.scene]).then(() => show_error(''), () => {}).then(async () => {
    await refresh();
    show_stage('');
  });
}

function save(blob, name) {
  const link = Object.assign(document.createElement('a'),
    { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

// Files ------------------------------------------------------------------------------------------

async function open_files(files) {
  painting = '';
  for (const file of files) {
    try {
      const buffer = await file.arrayBuffer();
      const { milliseconds } = await ask('open_file', [file.name, buffer], [buffer]);
      document.body.dataset.prefilter = milliseconds.toFixed(1);
      show_error('');
    } catch { /* it is on the page */ }
    await refresh();
  }
}

function wire_dropping() {
  let depth = 0;
  const has_files = (event) => event.dataTransfer?.types.includes('Files');
  const hint = (shown) => { $('drop-hint').hidden = !shown; };
  addEventListener('dragenter', (event) => { if (has_files(event)) { ++depth; hint(true); } });
  addEventListener('dragleave', (event) => { if (has_files(event) && --depth <= 0) hint(false); });
  addEventListener('dragover', (event) => { if (has_files(event)) event.preventDefault(); });
  addEventListener('drop', (event) => {
    depth = 0;
    hint(false);
    if (!has_files(event)) return;
    event.preventDefault();
    open_files([...event.dataTransfer.files]);
  });
}

// The picture by hand ----------------------------------------------------------------------------

const aspect = () => canvas.clientWidth / Math.max(1, canvas.clientHeight);

function wire_picture() {
  const pointers = new Map();
  let moved = { dx: 0, dy: 0, zoom: 0 };

  // All that has moved since the last answer, at once.
  const send = (call) => ask_newest('hand', async () => {
    const { dx, dy, zoom } = moved;
    moved = { dx: 0, dy: 0, zoom: 0 };
    const height = canvas.clientHeight;
    if (zoom) await ask('zoom', [zoom]);
    if (dx || dy) await ask(call, call === 'turn' ? [dx, height] : [dx, dy, height]);
    if (call === 'turn') await refresh(); else remember();
  });
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY, button: event.button });
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return look_at(event);
    const from = pointers.size === 2 ? spread() : 0;
    const dx = event.offsetX - before.x, dy = event.offsetY - before.y;
    Object.assign(before, { x: event.offsetX, y: event.offsetY });
    moved.dx += dx / pointers.size;
    moved.dy += dy / pointers.size;
    if (pointers.size === 2) {
      moved.zoom += Math.log(spread() / Math.max(1, from)) / Math.log(1.12);
      send('pan');
    } else {
      send(before.button === 1 || event.altKey ? 'turn'
        : before.button === 2 || event.shiftKey ? 'pan' : 'orbit');
    }
  });
  const end = (event) => pointers.delete(event.pointerId);
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    moved.zoom -= event.deltaY / (event.deltaMode === 1 ? 3 : 100);
    send('orbit');
  }, { passive: false });
  canvas.addEventListener('pointerleave', () => { $('look').textContent = ''; hide_marks(); });

  addEventListener('keydown', (event) => {
    const elsewhere = event.target !== canvas && event.target !== document.body;
    if (elsewhere || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === 'Escape') return show_error('');
    if (!known_keys(event.key)) return;
    event.preventDefault();
    if (event.key.toLowerCase() === 'e') return step_environment(event.key === 'e' ? 1 : -1);
    ask('press', [event.key, aspect()]).then(refresh, () => {});
  });

  new ResizeObserver(() => ask_newest('size', () => ask('resize', canvas_size()))).observe(canvas);
}

function step_environment(step) {
  const sources = facts.environments.map((one) => `builtin:${one.name}`);
  const at = sources.indexOf($('environment').value);
  const source = sources[(at + step + sources.length) % sources.length];
  choose($('environment'), source, base_name(source));
  paint_environment(source);
}

// Keys that are one character or an arrow; Tab and the like stay the browser's.
const known_keys = (key) => key.length === 1 && key !== ' ' || key.startsWith('Arrow') || key === 'Home';

// Where the pixel under the mouse looks, on the picture of each map.
function look_at(event) {
  const ratio = canvas_size()[0] / Math.max(1, canvas.clientWidth);
  const [x, y] = [event.offsetX * ratio, event.offsetY * ratio];
  ask_newest('hover', async () => {
    const hover = await ask('hover', [x, y]);
    const numbers = hover.reflected.map((value) => value.toFixed(2).replace('-', '−')).join(', ');
    $('look').textContent = `${hover.object === undefined ? 'looks' : 'r ='} (${numbers})`;
    for (const [projection, place] of Object.entries(hover.places)) {
      const mark = document.querySelector(`[data-map="${projection}"] .mark`);
      if (!mark) continue;
      mark.hidden = false;
      mark.style.left = `${100 * place.x}%`;
      mark.style.top = `${100 * place.y}%`;
      mark.title = `face ${place.face}, (${place.s.toFixed(3)}, ${place.t.toFixed(3)})`;
    }
  });
}
const canvas_size = () => {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  return [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
};
function hide_marks() {
  for (const mark of document.querySelectorAll('.mark')) mark.hidden = true;
}

// Maps -------------------------------------------------------------------------------------------

function show_maps() {
  const height = 90 * Math.min(Math.ceil(devicePixelRatio || 1), 2);
  ask('show_maps', [{ content: $('map-content').value, height,
    projections: facts.projections.map((projection) => projection.name) }]);
}

function show_map({ projection, picture }) {
  const surface = document.querySelector(`[data-map="${projection}"] canvas`);
  surface.width = picture.width;
  surface.height = picture.height;
  surface.getContext('2d').putImageData(picture, 0, 0);
}

function make_map_list() {
  $('map-list').replaceChildren(...facts.projections.map(({ name, aspect }) => {
    const figure = document.createElement('figure');
    figure.dataset.map = name;
    const map = document.createElement('div');
    map.className = 'map';
    map.style.aspectRatio = aspect;
    const surface = document.createElement('canvas');
    surface.setAttribute('role', 'img');
    surface.setAttribute('aria-label', `The ${name} map`);
    surface.style.width = '100%';
    const mark = document.createElement('div');
    mark.className = 'mark';
    mark.hidden = true;
    map.append(surface, mark);
    const caption = document.createElement('figcaption');
    caption.textContent = name;
    figure.append(map, caption);
    return figure;
  }));
}

// Start ------------------------------------------------------------------------------------------

function fill_lists() {
  options($('environment'), facts.environments.map((one) => (
    { value: `builtin:${one.name}`, text: one.name, title: one.description })));
  options($('mesh'), by_name(facts.meshes));
  options($('method'), by_name(facts.methods));
  options($('other'), by_name(facts.methods));
  options($('preset'), [{ value: '', text: 'choose …' }, ...by_name(facts.materials)]);
  options($('tone-map'), facts.tone_maps.map((name) => ({ value: name, text: name })));
  options($('fresnel'), [{ value: '', text: 'none: all light' }, { value: 'index', text: 'glass, by index' },
    ...facts.metals.map((metal) => ({ value: `metal=${metal}`, text: metal }))]);
  if (facts.bumps)
    options($('bump-source'), [{ value: '', text: 'none' }, ...by_name(facts.bumps)]);
  $('keys').replaceChildren(...facts.keys.flatMap(({ keys, what }) => {
    const [term, meaning] = [document.createElement('dt'), document.createElement('dd')];
    term.textContent = keys;
    meaning.textContent = what;
    return [term, meaning];
  }));
  $('version').textContent = `mirrorball ${facts.version} · ${facts.renderer}`;
}

async function start() {
  show_stage('Loading …');
  const target = canvas.transferControlToOffscreen();
  const [width, height] = canvas_size();
  const started = await ask('start', [target, width, height, state_of_address()], [target]);
  facts = started.facts;
  fill_lists();
  make_map_list();
  wire_controls();
  wire_dropping();
  wire_picture();
  await refresh();
  show_maps();
  show_stage('');
  if (started.warning) show_error(started.warning);
  document.body.dataset.ready = performance.now().toFixed(0);
  const source = environment().source ?? 'builtin:sunset';
  if (!is_file(source)) paint_environment(source);
  // For tests, and for whoever likes the console.
  globalThis.mirrorball = { ask, refresh };
}

if (!globalThis.WebAssembly || !canvas.transferControlToOffscreen)
  show_error('This browser is too old: WebAssembly and drawing away from the page are needed.');
else
  start().catch((error) => { ready_text = 'Stopped.'; show_stage(''); show_error(error.message); });
