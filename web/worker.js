// The library at work, away from the page: its module and its drawing. The page stays responsive
// whatever is read or prefiltered here.
//
// The page asks {id, call, args} and is answered {id, result}; a result with an `error` is a failure
// in the library's words. Unasked it is told: {stage, share} what takes its time and how much of it is
// done, where that is known; {frame} after each picture; {maps} the maps' pictures when they have changed.
import load_mirrorball from './mirrorball.js';

const kFolder = '/files';
let module, page, canvas, gl;
let scheduled = false, drawable = false, map_wish = null, sent_maps = new Map(), drawn_count = 0;
// The picture's size in pixels; while it changes it may be drawn smaller, so that it follows the hand.
let full = [1, 1], share = 1, resting = 0, held = false;
const kSlow = 40, kQuick = 20, kLeastShare = 0.2, kRest = 200;  // milliseconds, and of a side

// Messages name files as they were dropped.
const parsed = (text) => JSON.parse(text, (key, value) =>
  key === 'error' ? value.replaceAll(`${kFolder}/`, '') : value);
const tell = (message, transfer = []) => self.postMessage(message, transfer);

// Progress ---------------------------------------------------------------------------------------

// What takes less than this says nothing, and no two words come nearer one another: milliseconds.
const kPatience = 50, kBetweenWords = 30;
// Of the call that runs: its beginning, what it is about, and what was said of it.
let began = 0, about = '', said = '', said_at = 0;
const kWords = { reading: 'Reading', prefiltering: 'Prefiltering', drawing: 'Drawing' };

function begin(what = '') {
  [began, about] = [performance.now(), what];
}

function say(stage, share) {
  [said, said_at] = [stage, performance.now()];
  tell({ stage, share });
}

function be_quiet() {
  if (said) say('');
}

// The library calls this from the midst of its work; messages leave at once.
function on_progress(what, share) {
  const stage = `${[kWords[what], what !== 'prefiltering' && about].filter(Boolean).join(' ')} …`;
  const now = performance.now();
  if (now - began < kPatience || (stage === said && now - said_at < kBetweenWords)) return;
  say(stage, share);
}

// Drawing ----------------------------------------------------------------------------------------

function draw_once() {
  const start = performance.now();
  begin(about);
  const answer = parsed(page.draw(canvas.width, canvas.height));
  be_quiet();
  // Reading one pixel waits for the picture: the time is that of all of it.
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  return { ...answer, milliseconds: performance.now() - start, count: ++drawn_count };
}

function set_size(share) {
  const [width, height] = full.map((side) => Math.max(1, Math.round(side * share)));
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
}

// While things change: as large as the machine draws in time.
function tick() {
  scheduled = false;
  if (!drawable) return;
  set_size(share);
  const frame = draw_once();
  tell({ frame: { ...frame, changed: true, smooth: false } });
  if (frame.error) return;
  if (frame.milliseconds > kSlow)
    share = Math.max(kLeastShare, share * Math.max(0.5, Math.sqrt(kSlow / frame.milliseconds) * 0.9));
  else if (frame.milliseconds < kQuick)
    share = Math.min(1, share * 1.25);
  clearTimeout(resting);
  resting = setTimeout(rest, share < 1 ? kRest : 0);
}

// When nothing changes any more: whole, and smoother with each.
function rest() {
  if (scheduled) return;
  set_size(1);
  const frame = draw_once();
  tell({ frame: { ...frame, smooth: frame.smooth && !held } });
  if (frame.error) return;
  if (frame.smooth) return send_maps();
  resting = setTimeout(rest, 0);
}

function schedule() {
  if (scheduled || !drawable) return;
  scheduled = true;
  self.requestAnimationFrame(tick);
}

// The maps' pictures, when the picture itself is done.
function send_maps() {
  if (!map_wish) return;
  const maps = [];
  for (const projection of map_wish.projections) {
    const picture = page.map_picture(map_wish.content, projection, map_wish.height);
    if (picture.error) return tell({ failure: picture.error });
    if (sent_maps.get(projection) === picture.version) continue;
    sent_maps.set(projection, picture.version);
    const rgba = new Uint8ClampedArray(picture.rgba);
    maps.push({ projection, picture: new ImageData(rgba, picture.width, picture.height) });
  }
  if (maps.length) tell({ maps });
}

// Files ------------------------------------------------------------------------------------------

function is_picture(bytes) {
  const starts = (...codes) => codes.every((code, i) => bytes[i] === code);
  const has = (at, text) => [...text].every((c, i) => bytes[at + i] === c.charCodeAt(0));
  return starts(0x89, 0x50, 0x4e, 0x47) || starts(0xff, 0xd8, 0xff) ||
    (has(0, 'RIFF') && has(8, 'WEBP')) || has(4, 'ftypavif');
}

// PNG, JPEG and the like by the browser's own decoder, as src/io/decoded_picture.cpp reads it.
async function decoded(bytes) {
  const bitmap = await createImageBitmap(new Blob([bytes]),
    { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  const { width, height } = bitmap;
  const surface = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  surface.drawImage(bitmap, 0, 0);
  const texels = surface.getImageData(0, 0, width, height).data;
  const file = new Uint8Array(16 + 8 + texels.length);
  new TextEncoder().encodeInto('mirrorball RGBA8', file);
  new DataView(file.buffer).setUint32(16, width, true);
  new DataView(file.buffer).setUint32(20, height, true);
  file.set(texels, 24);
  return file;
}

// A picture of floats as a file: rows from the bottom, in this machine's order of bytes.
function pfm(width, height, values) {
  const head = new TextEncoder().encode(`PF\n${width} ${height}\n-1.0\n`);
  const file = new Uint8Array(head.length + values.byteLength);
  file.set(head);
  const row = 3 * width;
  for (let y = 0; y < height; ++y) {
    const line = values.subarray((height - 1 - y) * row, (height - y) * row);
    file.set(new Uint8Array(line.buffer, line.byteOffset, line.byteLength), head.length + 4 * y * row);
  }
  return file;
}

const safe_name = (name) => name.replace(/[/,\0]/g, '_') || 'file';

// Into the file system of the module, where the library finds it.
async function put_file(name, buffer) {
  let bytes = new Uint8Array(buffer);
  const safe = safe_name(name);
  if (is_picture(bytes)) {
    try {
      bytes = await decoded(bytes);
    } catch {
      return { error: `${safe}: is a picture that this browser cannot decode` };
    }
  }
  module.FS.writeFile(`${kFolder}/${safe}`, bytes);
  return {};
}

async function open_file(name, buffer) {
  const safe = safe_name(name);
  const put = await put_file(name, buffer);
  if (put.error) return put;
  // By its name alone, as on a command line in the file's folder: messages say no more of it.
  const answer = parsed(page.drop(safe));
  if (answer.error) module.FS.unlink(`${kFolder}/${safe}`);
  return answer;
}

// What the page asks -----------------------------------------------------------------------------

const calls = {
  async start(target, width, height, state) {
    say('Loading the library …');
    module = await load_mirrorball();
    canvas = target;
    full = [width, height];
    set_size(1);
    const handle = module.GL.createContext(canvas, {
      majorVersion: 2, minorVersion: 0, alpha: false, depth: true, stencil: false,
      antialias: false, powerPreference: 'high-performance', enableExtensionsByDefault: true });
    if (!handle) return { error: 'This browser has no WebGL2, or it is switched off.' };
    module.GL.makeContextCurrent(handle);
    gl = module.GL.currentContext.GLctx;
    for (const name of ['EXT_color_buffer_float', 'OES_texture_float_linear', 'EXT_float_blend'])
      gl.getExtension(name);
    if (!gl.getExtension('EXT_color_buffer_float'))
      return { error: 'This graphics driver draws no half-float pictures (EXT_color_buffer_float).' };
    module.FS.mkdir(kFolder);
    module.FS.chdir(kFolder);
    page = new module.Page(on_progress);
    let answer = parsed(page.open(state, width / height));
    let warning;
    if (answer.error && state) {
      warning = answer.error;
      answer = parsed(page.open('', width / height));
    }
    if (answer.error) return answer;
    say('Prefiltering …');
    drawable = true;
    set_size(share = 0.5);
    const first = draw_once();
    tell({ frame: first });
    schedule();
    const facts = parsed(module.Page.facts());
    if (gl.getExtension('WEBGL_debug_renderer_info'))
      facts.renderer = gl.getParameter(0x9246);  // UNMASKED_RENDERER_WEBGL
    return { facts, warning, error: first.error };
  },
  resize(width, height) {
    if (full[0] === width && full[1] === height) return;
    full = [width, height];
    set_size(share);
    // In the same turn: no empty picture is shown in between.
    tell({ frame: draw_once() });
  },
  status: () => parsed(page.status()),
  async open_file(name, buffer) {
    begin(name);
    say(`Reading ${name} …`);
    const answer = await open_file(name, buffer);
    if (answer.error) return answer;
    say('Prefiltering …');
    const start = performance.now();
    set_size(share);
    const frame = draw_once();
    tell({ frame });
    return frame.error ? frame : { ...answer, milliseconds: performance.now() - start };
  },
  put_file,
  // Of a worker that draws nothing, for one that does.
  async builtin(source) {
    module ??= await load_mirrorball();
    page ??= new module.Page(on_progress);
    begin(source.replace('builtin:', ''));
    const map = page.builtin(source);
    if (map.error) return { error: map.error };
    return { width: map.width, height: map.height, values: new Float32Array(map.values) };
  },
  take_builtin(source, { width, height, values }) {
    const file = `${kFolder}/.builtin.pfm`;
    module.FS.writeFile(file, pfm(width, height, values));
    const answer = parsed(page.take_builtin(source, file));
    module.FS.unlink(file);
    return answer;
  },
  set_scene: (scene) => parsed(page.set_scene(JSON.stringify(scene))),
  edit_scene: (scene) => parsed(page.edit_scene(JSON.stringify(scene))),
  set_state: (state) => parsed(page.set_state(state)),
  set_comparison: (...all) => parsed(page.set_comparison(...all)),
  set_stops: (stops) => parsed(page.set_stops(stops)),
  orbit: (...all) => page.orbit(...all),
  pan: (...all) => page.pan(...all),
  zoom: (steps) => page.zoom(steps),
  hold(by_hand) {
    held = by_hand;
    page.hold(held);
  },
  turn: (...all) => parsed(page.turn(...all)),
  frame_all: (aspect) => page.frame_all(aspect),
  press: (...all) => parsed(page.press(...all)),
  hover: (x, y) => parsed(page.hover(x, y, ...full)),
  show_maps(wish) {
    if (wish.content !== map_wish?.content || wish.height !== map_wish?.height) sent_maps.clear();
    map_wish = wish;
  },
  // The picture, as smooth as it gets.
  async screenshot() {
    set_size(1);
    let frame;
    do frame = draw_once(); while (!frame.error && !frame.smooth);
    if (frame.error) return frame;
    return { blob: await canvas.convertToBlob({ type: 'image/png' }) };
  },
};

// Calls change nothing in the picture, or it is drawn anew.
const silent = new Set(['status', 'hover', 'screenshot', 'builtin', 'put_file', 'show_maps']);
let last = Promise.resolve();

async function answer({ id, call, args }) {
  let result;
  begin();
  try {
    result = await calls[call](...args);
  } catch (error) {
    result = { error: `The library stopped: ${error?.message ?? error}. Load the page again.` };
  }
  tell({ id, result: result ?? {} });
  be_quiet();
  if (!silent.has(call)) schedule();
  if (call === 'show_maps') rest();
}

// In their order, also where one waits for something.
self.onmessage = ({ data }) => { last = last.then(() => answer(data)); };
