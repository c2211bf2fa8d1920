// The controls: what they say to the scene, and what the scene says to them. Each changes one thing in
// it and sends it back.
import { $, ask, ask_newest, show_ready } from './library.js';
import { base_name, busy_change, change_material, change_scene, environment, facts, material, object,
  open_files, paint_environment, refresh, save, scene, source, status } from './shown.js';

// Values -----------------------------------------------------------------------------------------

export function options(select, entries) {
  select.replaceChildren(...entries.map(({ value, text, title }) => {
    const option = new Option(text, value);
    if (title) option.title = title;
    return option;
  }));
}
export const by_name = (entries) =>
  entries.map((entry) => ({ value: entry.name, text: entry.name, title: entry.description }));

// A choice that is not on the list (a file, numbers of one's own) gets a place at its end.
export function choose(select, value, text = value) {
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

// The scene on the controls ------------------------------------------------------------------------

export function show_controls() {
  const light = environment();
  choose($('environment'), source(), base_name(source()));
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
  show_ready(`${base_name(source())}: ${status.notes.join('; ')}`);
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

export function wire_controls() {
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
  for (const id of ['environment-file', 'mesh-file'])
    $(id).addEventListener('change', () => {
      if ($(id).files.length) open_files([...$(id).files]);
      $(id).value = '';
    });
  $('controls').addEventListener('submit', (event) => event.preventDefault());
}

export function step_environment(step) {
  const sources = facts.environments.map((one) => `builtin:${one.name}`);
  const at = sources.indexOf($('environment').value);
  const next = sources[(at + step + sources.length) % sources.length];
  choose($('environment'), next, base_name(next));
  paint_environment(next);
}
