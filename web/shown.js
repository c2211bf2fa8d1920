// What is shown: the scene as the library has it, changes to it, the files opened, and all of it in the
// page's address.
import { $, ask, ask_newest, ask_painter, is_waiting, show_error, show_stage } from './library.js';

// What there is to choose from, and the library's state when it was last asked.
export let facts, status;
// What the library leaves out of a scene, because it is so unless it is said.
const kMaterial = { base_color: 1, mirror: 1, glossy: 0, diffuse: 0, transmission: 0,
  lobe: 'ggx:0.3', fresnel: '', coupling: 'layered', index: 1.5 };

export const scene = () => status.scene;
export const environment = () => (status.scene.environment ??= {});
export const object = () => status.scene.objects?.[status.selected];
export const material = () => ({ ...kMaterial, ...object()?.material });
export const source = () => environment().source ?? 'builtin:sunset';
export const base_name = (path) => path.split('/').pop();
const is_file = (name) => !name.startsWith('builtin:');

// Shows the state whenever it was asked for.
let show = () => {};
export function begin(what_there_is, show_state) {
  [facts, show] = [what_there_is, show_state];
}

export async function refresh() {
  status = await ask('status');
  show();
  remember();
  if (status.coarse && painting !== source()) paint_environment(source());
}

// Changes ----------------------------------------------------------------------------------------

export function change_scene(change) {
  change(status.scene);
  ask_newest('scene', async () => {
    try {
      await ask('edit_scene', [status.scene]);
      show_error('');
    } finally {
      if (!is_waiting('scene')) await refresh();
    }
  });
}

// Of what may take a while.
export function busy_change(change) {
  show_stage('page', 'Prefiltering …');
  change(status.scene);
  ask('edit_scene', [status.scene]).then(() => show_error(''), () => {}).then(async () => {
    await refresh();
    show_stage('page', '');
  });
}

export function change_material(change) {
  change_scene((scene) => {
    scene.objects ??= [{}];
    const one = scene.objects[status.selected];
    one.material = { ...one.material, ...change };
  });
}

// A built-in environment, drawn elsewhere, and then in place of what is shown: if nobody has chosen
// another one meanwhile.
let painting = '';
export async function paint_environment(source) {
  painting = source;
  show_stage('painter', `Drawing ${base_name(source)} …`);
  try {
    const map = await ask_painter('builtin', [source]);
    if (painting !== source) return;
    await ask('take_builtin', [source, map], [map.values.buffer]);
    painting = '';
    show_error('');
    await refresh();
    document.body.dataset.painted = source;
  } catch { /* it is on the page */
    await refresh();
  }
}

// Files ------------------------------------------------------------------------------------------

// Of files that come together, those that another one names are only laid beside it.
function is_beside(name, all) {
  const is_scene = (one) => /\.json$/i.test(one);
  return /\.(bin|mtl)$/i.test(name) || (all.some(is_scene) && !is_scene(name));
}

export async function open_files(files) {
  const names = files.map((file) => file.name);
  const beside = files.length > 1 ? files.filter((file) => is_beside(file.name, names)) : [];
  try {
    for (const file of beside) {
      const buffer = await file.arrayBuffer();
      await ask('put_file', [file.name, buffer], [buffer]);
    }
  } catch { return; /* it is on the page */ }
  for (const file of files.filter((one) => !beside.includes(one))) await open_file(file);
}

async function open_file(file) {
  const before = source();
  try {
    const buffer = await file.arrayBuffer();
    const { milliseconds } = await ask('open_file', [file.name, buffer], [buffer]);
    document.body.dataset.prefilter = milliseconds.toFixed(1);
    show_error('');
  } catch { /* it is on the page */ }
  await refresh();
  // What is being drawn was to be in place of what was there before.
  if (source() !== before && !status.coarse) painting = '';
}

export function save(blob, name) {
  const link = Object.assign(document.createElement('a'),
    { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
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

export function remember() {
  clearTimeout(remembering);
  remembering = setTimeout(async () => {
    const { state } = await ask('status');
    own_hash = '#' + encodeURI(linkable(state));
    history.replaceState(null, '', own_hash);
  }, 250);
}

export function state_of_address() {
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
