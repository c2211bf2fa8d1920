// The page: its start.
import { by_name, options, show_controls, wire_controls } from './controls.js';
import { $, ask, listen, show_error, show_stage, stop } from './library.js';
import { canvas, canvas_size, make_map_list, show_frame, show_map, show_maps, wire_picture }
  from './picture.js';
import { begin, facts, open_files, refresh, state_of_address } from './shown.js';

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

// While something is held, the picture stays the quickest there is.
function wire_holding() {
  let held = false;
  const hold = (by_hand) => { if (by_hand !== held) ask('hold', [held = by_hand]); };
  addEventListener('pointerdown', (event) => {
    if (event.target.matches('canvas, input[type=range]')) hold(true);
  });
  for (const end of ['pointerup', 'pointercancel', 'blur']) addEventListener(end, () => hold(false));
}

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
  listen({ frame: show_frame, map: show_map });
  show_stage('page', 'Loading …');
  const target = canvas.transferControlToOffscreen();
  const [width, height] = canvas_size();
  const started = await ask('start', [target, width, height, state_of_address()], [target]);
  begin(started.facts, show_controls);
  fill_lists();
  make_map_list();
  wire_controls();
  wire_dropping();
  wire_holding();
  wire_picture();
  await refresh();
  show_maps();
  show_stage('page', '');
  if (started.warning) show_error(started.warning);
  document.body.dataset.ready = performance.now().toFixed(0);
  // For tests, and for whoever likes the console.
  globalThis.mirrorball = { ask, refresh };
}

if (!globalThis.WebAssembly || !canvas.transferControlToOffscreen)
  show_error('This browser is too old: WebAssembly and drawing away from the page are needed.');
else
  start().catch((error) => stop(error.message));
