// The page in a real browser: it loads, draws what the program draws, takes files, refuses bad ones in
// the program's words, and keeps its state in its address.
//
//     node --test page_test.mjs
//
// MIRRORBALL_PAGE      the folder that `make web` built
// MIRRORBALL_PROGRAM   the program of this machine: its pictures and messages are what is expected
// MIRRORBALL_SHARED    a folder with hdri/venice.hdr, if there is one
// MIRRORBALL_OUTPUT    where the pictures that are compared and the screenshots go
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { chromium } from 'playwright-core';
import { serve } from './server.mjs';

const page_folder = process.env.MIRRORBALL_PAGE;
const program = process.env.MIRRORBALL_PROGRAM;
const output = process.env.MIRRORBALL_OUTPUT ?? 'out';
const shared = process.env.MIRRORBALL_SHARED;
mkdirSync(output, { recursive: true });

// In a browser that draws without a graphics card.
const kArguments = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader'];
// CSS pixels; the picture is what the layout leaves of it.
const kUsual = { width: 900, height: 560 }, kWide = { width: 1280, height: 800 }, kPhone = { width: 390, height: 844 };

let server, browser, page;
const complaints = [];
const figures = {};

async function open(fragment = '', options = {}) {
  const one = await browser.newPage({ viewport: kUsual, ...options });
  one.on('console', (message) => {
    // The driver tells that reading pixels waits, which is what it is for.
    if (message.type() === 'error') complaints.push(message.text());
  });
  one.on('pageerror', (error) => complaints.push(String(error)));
  await one.goto(server.address + fragment);
  await one.waitForFunction(() => document.body.dataset.ready, null, { timeout: 60_000 });
  return one;
}

const painted = (one) => one.waitForFunction(() => document.body.dataset.painted, null,
  { timeout: 120_000 });
const ask = (call, ...args) => page.evaluate(([call, args]) => mirrorball.ask(call, args), [call, args]);
const set_scene = async (change) => {
  const { scene } = await ask('status');
  change(scene);
  await ask('set_scene', scene);
};
const run = (...args) => execFileSync(program, [...args, '--quiet'], { cwd: output });

// Texels of a PNG, decoded by the browser, as [width, height, base64 of RGBA].
async function texels(bytes) {
  const [width, height, text] = await page.evaluate(async (base64) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob(),
      { colorSpaceConversion: 'none' });
    const surface = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    surface.drawImage(bitmap, 0, 0);
    const data = surface.getImageData(0, 0, bitmap.width, bitmap.height).data;
    let binary = '';
    for (let i = 0; i < data.length; i += 32768)
      binary += String.fromCharCode(...data.subarray(i, i + 32768));
    return [bitmap.width, bitmap.height, btoa(binary)];
  }, Buffer.from(bytes).toString('base64'));
  return { width, height, rgba: Buffer.from(text, 'base64') };
}

async function screenshot() {
  const base64 = await page.evaluate(async () => {
    const { blob } = await mirrorball.ask('screenshot');
    const bytes = new Uint8Array(await blob.arrayBuffer());
    let binary = '';
    for (let i = 0; i < bytes.length; i += 32768)
      binary += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(binary);
  });
  return Buffer.from(base64, 'base64');
}

// How far two pictures are apart, in steps of 255: the mean, and what 99 % of all channels keep within.
function differences(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height]);
  const counts = new Array(256).fill(0);
  let sum = 0, count = 0;
  for (let i = 0; i < a.rgba.length; ++i) {
    if (i % 4 === 3) continue;
    const apart = Math.abs(a.rgba[i] - b.rgba[i]);
    ++counts[apart];
    sum += apart;
    ++count;
  }
  let below = 0, within = 0;
  while ((below += counts[within]) < 0.99 * count) ++within;
  return { mean: sum / count, within, most: counts.findLastIndex((n) => n > 0) };
}

// The page's picture against the program's of the same scene and size.
async function compare_with_program(name) {
  const { scene } = await ask('status');
  // What was dropped lies beside the scene here.
  writeFileSync(join(output, `${name}.json`), JSON.stringify(scene).replaceAll('/files/', ''));
  const bytes = await screenshot();
  writeFileSync(join(output, `${name}-page.png`), bytes);
  const ours = await texels(bytes);
  run('render', `${name}.json`, '-o', `${name}.png`, '--width', String(ours.width),
    '--height', String(ours.height));
  return differences(ours, await texels(readFileSync(join(output, `${name}.png`))));
}

const drop = (name, bytes) => drop_all({ [name]: bytes });
async function drop_all(files) {
  const list = Object.entries(files).map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]);
  await page.evaluate((list) => {
    const carried = new DataTransfer();
    for (const [name, base64] of list)
      carried.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    document.body.dataset.prefilter = '';
    document.getElementById('error').hidden = true;
    document.body.dispatchEvent(new DragEvent('drop',
      { dataTransfer: carried, bubbles: true, cancelable: true }));
  }, list);
  await page.waitForFunction(() => document.body.dataset.prefilter ||
    !document.getElementById('error').hidden, null, { timeout: 60_000 });
  await ask('status');
}
const error_text = () => page.evaluate(() => {
  const error = document.getElementById('error');
  return error.hidden ? '' : error.textContent;
});

// Moves a slider as a hand does, and gives how long it takes until the new picture is there.
async function slide(id, value) {
  return page.evaluate(async ([id, value]) => {
    const input = document.getElementById(id);
    const count = Number(document.body.dataset.changes);
    const start = performance.now();
    input.value = value;
    input.dispatchEvent(new Event('input', { bubbles: true }));
    await new Promise((resolve) => {
      const look = () => Number(document.body.dataset.changes) > count ? resolve() : setTimeout(look, 0);
      look();
    });
    return performance.now() - start;
  }, [id, value]);
}
const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

before(async () => {
  server = await serve(page_folder);
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: kArguments });
});
after(async () => {
  await browser?.close();
  server?.close();
  for (const [name, value] of Object.entries(figures)) console.log(`figure: ${name}: ${value}`);
});

test('the page loads, without complaint, and shows a picture soon', async () => {
  page = await open();
  figures['first picture, ms from navigation'] = await page.evaluate(() => document.body.dataset.ready);
  assert.deepEqual(complaints, []);
  assert.equal(await error_text(), '');
  await painted(page);
});

test('the download is small', () => {
  let bytes = 0;
  for (const file of readdirSync(page_folder))
    bytes += gzipSync(readFileSync(join(page_folder, file)), { level: 9 }).length;
  figures['download, bytes by gzip -9'] = bytes;
  assert.ok(bytes <= 3_000_000, `${bytes} bytes`);
});

test('its picture is the program’s', async () => {
  const apart = await compare_with_program('usual');
  figures['page and program apart, of 255'] = JSON.stringify(apart);
  assert.ok(apart.mean < 0.5 && apart.within <= 3, JSON.stringify(apart));
  // The same as a file, which is at hand sooner.
  run('sky', 'sunset', '-o', 'sunset.pfm');
  await drop('sunset.pfm', readFileSync(join(output, 'sunset.pfm')));
  assert.equal(await error_text(), '');
});

test('every method draws what the program draws', async () => {
  const methods = await page.$$eval('#method option', (options) => options.map((one) => one.value));
  assert.equal(methods.length, 12);
  for (const method of methods) {
    await page.selectOption('#method', method);
    await page.waitForFunction(() => !document.body.classList.contains('busy'));
    assert.equal((await ask('status')).scene.method ?? 'cube', method);
    const apart = await compare_with_program(`method-${method}`);
    assert.equal(await error_text(), '');
    assert.ok(apart.mean < 0.5 && apart.within <= 4, `${method}: ${JSON.stringify(apart)}`);
  }
  await page.selectOption('#method', 'cube');
});

test('materials draw what the program draws', async () => {
  for (const material of ['gold', 'plastic', 'satin-plastic', 'phong-100', 'glass']) {
    await set_scene((scene) => { scene.objects[0].material = material; });
    const apart = await compare_with_program(`material-${material}`);
    assert.ok(apart.mean < 0.5 && apart.within <= 4, `${material}: ${JSON.stringify(apart)}`);
  }
});

test('sliders change the material, exactly', async () => {
  await set_scene((scene) => { scene.objects[0].material = 'satin-gold'; });
  await page.evaluate(() => mirrorball.refresh());
  const times = [];
  for (let i = 0; i < 12; ++i) times.push(await slide('lobe-parameter', 0.2 + 0.05 * i));
  figures['slider, a new lobe on screen, ms (median, worst)'] =
    `${median(times).toFixed(0)}, ${Math.max(...times).toFixed(0)}`;
  const turns = [];
  for (let i = 0; i < 6; ++i) turns.push(await slide('stops', i / 4 - 1));
  figures['slider, another exposure, ms (median)'] = median(turns).toFixed(0);
  await slide('lobe-parameter', 0.437);
  await slide('diffuse', 0.25);
  await page.waitForTimeout(300);
  const { scene } = await ask('status');
  assert.equal(scene.objects[0].material.lobe, 'ggx:0.437');
  assert.equal(scene.objects[0].material.diffuse, 0.25);
  const apart = await compare_with_program('slid');
  assert.ok(apart.mean < 0.5 && apart.within <= 4, JSON.stringify(apart));
});

// GGX next to a mirror takes long to prefilter: a hand that holds the slider need not wait for it.
test('a slider that is held shows quick pictures, and exact ones when it is let go', async () => {
  const slider = await page.$('#lobe-parameter');
  await slider.evaluate((one) => one.scrollIntoView({ block: 'center' }));
  const range = await slider.boundingBox();
  const y = range.y + range.height / 2;
  await page.mouse.move(range.x + 0.4 * range.width, y);
  await page.mouse.down();
  for (const share of [0.3, 0.2, 0.1]) await page.mouse.move(range.x + share * range.width, y);
  await page.waitForTimeout(800);
  const parameter = Number((await ask('status')).scene.objects[0].material.lobe.slice(4));
  assert.ok(parameter > 0.02 && parameter < 0.15, `ggx:${parameter}`);
  assert.equal(await page.evaluate(() => document.body.dataset.smooth), 'false');
  await page.mouse.up();
  await page.waitForFunction(() => document.body.dataset.smooth === 'true', null, { timeout: 60_000 });
  const apart = await compare_with_program('let-go');
  assert.ok(apart.mean < 0.5 && apart.within <= 4, JSON.stringify(apart));
  await page.evaluate(() => scrollTo(0, 0));
});

test('a generated panorama is dropped, in every format, and looks as the program shows it', async () => {
  await set_scene((scene) => { scene.objects[0].material = 'satin-gold'; });
  run('sky', 'studio', '-o', 'studio.hdr', '--size', '1024');
  const times = [];
  for (let i = 0; i < 3; ++i) {
    await drop('studio.hdr', readFileSync(join(output, 'studio.hdr')));
    assert.equal(await error_text(), '');
    times.push(Number(await page.evaluate(() => document.body.dataset.prefilter)));
  }
  figures['1024 x 512 dropped: prefiltered and drawn, ms'] = times.map((t) => t.toFixed(0)).join(', ');
  assert.match(await page.textContent('#status'), /studio\.hdr: Radiance HDR, equirect 1024 x 512/);
  const apart = await compare_with_program('dropped');
  assert.ok(apart.mean < 0.5 && apart.within <= 4, JSON.stringify(apart));

  const first = await texels(await screenshot());
  for (const [file, ...options] of [['studio.exr'], ['studio.pfm'], ['studio.ktx2'], ['studio.dds'],
    ['cube.ktx2', '--to', 'cube']]) {
    run('convert', 'studio.hdr', '-o', file, '--size', file === 'cube.ktx2' ? '256' : '1024', ...options);
    await drop(file, readFileSync(join(output, file)));
    assert.equal(await error_text(), '', file);
    const apart = differences(first, await texels(await screenshot()));
    assert.ok(apart.mean < 0.6, `${file}: ${JSON.stringify(apart)}`);
  }
});

test('a PNG is decoded by the browser as the program decodes it', async () => {
  run('sky', 'grid', '-o', 'grid.png', '--size', '512');
  await drop('grid.png', readFileSync(join(output, 'grid.png')));
  assert.equal(await error_text(), '');
  const apart = await compare_with_program('png');
  assert.ok(apart.mean < 0.5 && apart.within <= 4, JSON.stringify(apart));
});

test('a real panorama is dropped', { skip: !shared && 'MIRRORBALL_SHARED is not set' }, async (t) => {
  const file = join(shared, 'hdri', 'venice.hdr');
  if (!existsSync(file)) return t.skip(`there is no ${file}`);
  await drop('venice.hdr', readFileSync(file));
  assert.equal(await error_text(), '');
  figures['venice.hdr dropped: prefiltered and drawn, ms'] =
    await page.evaluate(() => document.body.dataset.prefilter);
  writeFileSync(join(output, 'venice.hdr'), readFileSync(file));
  const apart = await compare_with_program('venice');
  assert.ok(apart.mean < 0.5 && apart.within <= 4, JSON.stringify(apart));
});

test('broken files are refused in the program’s words and change nothing', async () => {
  const good = readFileSync(join(output, 'studio.hdr'));
  const exr = readFileSync(join(output, 'studio.exr'));
  const before_state = (await ask('status')).state;
  const expected = {
    'cut.hdr': [good.subarray(0, good.length >> 1)],
    'head.hdr': [Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 200000\n')],
    'empty.hdr': [Buffer.alloc(0)],
    'cut.ktx2': [readFileSync(join(output, 'studio.ktx2')).subarray(0, 5000)],
    'cut.dds': [readFileSync(join(output, 'studio.dds')).subarray(0, 5000)],
    'cut.pfm': [readFileSync(join(output, 'studio.pfm')).subarray(0, 5000)],
    'scene.json': [Buffer.from('{"objects": [{"material": {"mirror": 1.5}}]}')],
    'bad.obj': [Buffer.from('v 0 0 0\nf 1 2 3\n')],
    'rubbish.hdr': [Buffer.from('rubbish'), /rubbish\.hdr: is in no format that is known here/],
    'cut.exr': [exr.subarray(0, exr.length >> 1), /cut\.exr: is truncated: ends at byte \d+/],
    'cut.png': [readFileSync(join(output, 'grid.png')).subarray(0, 300), /cut\.png: .*cannot decode/],
  };
  // A file whose header says that its levels are packed by Zstandard.
  const packed = readFileSync(join(output, 'studio.ktx2'));
  packed.writeUInt32LE(2, 44);
  expected['packed.ktx2'] = [packed, /packed\.ktx2: is compressed by Zstandard, which this build cannot read/];
  for (const [name, [bytes, words]] of Object.entries(expected)) {
    writeFileSync(join(output, name), bytes);
    await drop(name, bytes);
    const shown = await error_text();
    if (words) {
      assert.match(shown, words);
    } else {
      const verb = name.endsWith('.json') ? ['render', name, '-o', 'no.png']
        : name.endsWith('.obj') ? ['render', '--mesh', name, '-o', 'no.png'] : ['info', name];
      const told = spawnSync(program, verb, { cwd: output, encoding: 'utf8' }).stderr;
      assert.ok(shown.length > 10 && told.includes(shown.replace(/^objects\[\d+\]: /, '')),
        `${name}\n  page: ${shown}\n  program: ${told}`);
    }
  }
  assert.equal((await ask('status')).state, before_state);
  await page.keyboard.press('Escape');
});

test('a link shows the same scene', async () => {
  await set_scene((scene) => {
    scene.environment = { source: 'builtin:noon', yaw_degrees: 40 };
    scene.objects[0] = { mesh: 'torus', material: 'copper' };
    scene.method = 'octahedral';
    scene.lights = [{ directional: { direction: [1, 1, 0], normal_irradiance: 2 } }];
  });
  await page.evaluate(() => { delete document.body.dataset.painted; mirrorball.refresh(); });
  await painted(page);
  await page.waitForTimeout(500);
  const fragment = new URL(page.url()).hash;
  const [state, picture] = [(await ask('status')).state, await texels(await screenshot())];
  const first = page;
  page = await open(fragment);
  await painted(page);
  assert.equal((await ask('status')).state, state);
  assert.equal(differences(picture, await texels(await screenshot())).most, 0);
  await page.close();
  page = first;

  const other = await open('#scene={"method":"no-such"}');
  assert.match(await other.textContent('#error'), /no-such/);
  await other.close();
});

test('another address shows its scene at once, coarse, and then whole', async () => {
  await set_scene((scene) => { scene.environment = { source: 'builtin:white' }; });
  const time = await page.evaluate(async () => {
    delete document.body.dataset.painted;
    const start = performance.now();
    location.hash = '#scene={"environment":{"source":"builtin:sunset"},"objects":[{"mesh":"torus"}]}';
    while ((await mirrorball.ask('status')).scene.objects[0].mesh !== 'torus')
      await new Promise((resolve) => setTimeout(resolve, 5));
    return performance.now() - start;
  });
  figures['another address, coarse, ms'] = time.toFixed(0);
  // The whole takes seconds, also where nothing else is computed.
  assert.ok(time < 1500, `${time} ms`);
  assert.ok((await ask('status')).coarse);
  await page.waitForFunction(() => document.getElementById('status').textContent.startsWith('Drawing sunset') &&
    document.getElementById('progress').value > 0.1);
  await painted(page);
  assert.equal((await ask('status')).coarse, false);
  assert.match(await page.textContent('#status'), /sunset: built-in, equirect 1024 x 512/);
});

test('an environment that comes late leaves the view and the sliders as they are', async () => {
  await page.selectOption('#environment', 'builtin:noon');
  const before = JSON.stringify((await ask('status')).scene.camera);
  await page.evaluate(() => mirrorball.ask('orbit', [40, 10, 400]));
  const turned = JSON.stringify((await ask('status')).scene.camera);
  assert.notEqual(turned, before);
  await page.evaluate(() => { delete document.body.dataset.painted; });
  await slide('mirror', 0.5);
  await painted(page);
  const { scene } = await ask('status');
  assert.equal(scene.environment.source, 'builtin:noon');
  assert.equal(scene.objects[0].material.mirror, 0.5);
  assert.equal(JSON.stringify(scene.camera), turned);
});

// A tetrahedron as glTF, its numbers beside it or in one file with it.
const kCorners = [[0, 1, 0], [0.94, -0.33, 0], [-0.47, -0.33, 0.82], [-0.47, -0.33, -0.82]];
const kFaces = [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]];
function tetrahedron() {
  const bin = Buffer.alloc(48 + 24);
  kCorners.flat().forEach((value, i) => bin.writeFloatLE(value, 4 * i));
  kFaces.flat().forEach((value, i) => bin.writeUInt16LE(value, 48 + 2 * i));
  const gltf = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    buffers: [{ byteLength: bin.length }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 24 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [-0.47, -0.33, -0.82], max: [0.94, 1, 0.82] },
      { bufferView: 1, componentType: 5123, count: 12, type: 'SCALAR' }] };
  return { bin, gltf };
}
function glb({ bin, gltf }) {
  const text = JSON.stringify(gltf), json = Buffer.from(text.padEnd(Math.ceil(text.length / 4) * 4));
  const words = (...values) => Buffer.from(Uint32Array.from(values).buffer);
  return Buffer.concat([words(0x46546c67, 2, 28 + json.length + bin.length), words(json.length, 0x4e4f534a),
    json, words(bin.length, 0x004e4942), bin]);
}
const obj = (scale) => kCorners.map((corner) => `v ${corner.map((x) => x * scale).join(' ')}\n`).join('') +
  kFaces.map((face) => `f ${face.map((i) => i + 1).join(' ')}\n`).join('');

test('meshes and scenes are dropped, look as the program shows them, and fail in its words', async () => {
  const keep = (files) => {
    for (const [name, bytes] of Object.entries(files)) writeFileSync(join(output, name), bytes);
    return files;
  };
  const check = async (name, mesh) => {
    assert.equal(await error_text(), '', name);
    assert.equal((await ask('status')).scene.objects[0].mesh.split('/').pop(), mesh);
    const apart = await compare_with_program(name);
    assert.ok(apart.mean < 0.5 && apart.within <= 4, `${name}: ${JSON.stringify(apart)}`);
    return texels(readFileSync(join(output, `${name}-page.png`)));
  };
  await set_scene((scene) => {
    scene.environment = { source: 'builtin:axes' };
    scene.objects = [{ mesh: 'sphere', material: 'gold' }];
    scene.lights = [];
  });
  await page.evaluate(() => { delete document.body.dataset.painted; mirrorball.refresh(); });
  await painted(page);

  await drop_all(keep({ 'corner.obj': obj(1) }));
  const usual = await check('mesh-obj', 'corner.obj');
  await drop_all(keep({ 'corner.glb': glb(tetrahedron()) }));
  assert.ok(differences(usual, await check('mesh-glb', 'corner.glb')).mean < 0.1);
  const beside = tetrahedron();
  beside.gltf.buffers[0].uri = 'corner.bin';
  await drop_all(keep({ 'corner.gltf': JSON.stringify(beside.gltf), 'corner.bin': beside.bin }));
  assert.ok(differences(usual, await check('mesh-gltf', 'corner.gltf')).mean < 0.1);
  // An edited file of the same name is another mesh: the view is as far from it as its size asks.
  const eye = async () => Math.hypot(...(await ask('status')).scene.camera.eye);
  await drop_all(keep({ 'corner.obj': obj(1) }));
  const near = await eye();
  await drop_all(keep({ 'corner.obj': obj(2) }));
  assert.ok(await eye() > 1.5 * near);

  // A scene, and what it names.
  run('sky', 'studio', '-o', 'room.hdr', '--size', '256');
  const scene = { environment: { source: 'room.hdr', yaw_degrees: 30 },
    objects: [{ mesh: 'corner.glb', material: 'copper' }], camera: { eye: [0, 1, 4], target: [0, 0, 0] } };
  await drop_all({ 'room.json': JSON.stringify(scene), 'room.hdr': readFileSync(join(output, 'room.hdr')),
    'corner.glb': glb(tetrahedron()) });
  await check('scene', 'corner.glb');
  assert.match(await page.textContent('#status'), /room\.hdr: Radiance HDR, equirect 256 x 128/);

  const { bin, gltf } = tetrahedron();
  const far = structuredClone(gltf);
  far.accessors[1].count = 1000;
  const before_state = (await ask('status')).state;
  for (const [name, bytes] of Object.entries(keep({
    'cut.obj': 'v 0 0 0\nv 1 0 0\n', 'numbers.obj': 'v 0 0 zero\nf 1 1 1\n', 'cut.glb': glb({ bin, gltf }).subarray(0, 300),
    'rubbish.glb': 'rubbish', 'far.glb': glb({ bin, gltf: far }), 'alone.gltf': JSON.stringify({ ...gltf,
      buffers: [{ byteLength: bin.length, uri: 'nowhere.bin' }] }), 'empty.gltf': '',
    'lost.json': '{"objects": [{"mesh": "nowhere.obj"}]}', 'dark.json': '{"environment": {"source": "nowhere.hdr"}}',
    'comma.json': '{"objects": [,]}', 'method.json': '{"method": "guess"}' }))) {
    await drop(name, Buffer.from(bytes));
    const shown = (await error_text()).replace(/^objects\[0\]: /, '');
    const told = spawnSync(program, name.endsWith('.json') ? ['render', name, '-o', 'no.png']
      : ['render', '--mesh', name, '-o', 'no.png'], { cwd: output, encoding: 'utf8' }).stderr;
    assert.ok(shown.length > 10 && told.includes(shown), `${name}\n  page: ${shown}\n  program: ${told}`);
  }
  assert.equal((await ask('status')).state, before_state);
});

test('reading and prefiltering say how far they are', async () => {
  run('sky', 'studio', '-o', 'large.hdr', '--size', '4096');
  await page.evaluate(() => {
    globalThis.seen = [];
    const bar = document.getElementById('progress');
    globalThis.watcher = new MutationObserver(() => {
      if (bar.hasAttribute('value'))
        seen.push([document.getElementById('status').textContent, bar.value, bar.getAttribute('aria-valuetext')]);
    });
    watcher.observe(bar, { attributes: true });
  });
  await set_scene((scene) => { scene.objects[0].material = 'satin-gold'; });
  await drop('large.hdr', readFileSync(join(output, 'large.hdr')));
  assert.equal(await error_text(), '');
  const seen = await page.evaluate(() => { watcher.disconnect(); return seen; });
  for (const [word, least] of [['Reading large.hdr …', 1], ['Prefiltering …', 3]]) {
    const of_word = seen.filter(([text]) => text === word);
    const shares = of_word.map(([, share]) => share);
    figures[`${word} told`] = `${of_word.length} times`;
    assert.ok(new Set(shares).size >= least && shares.every((share, i) => share > 0 && share < 1 &&
      share >= (shares[i - 1] ?? 0)), `${word} ${shares}`);
    assert.match(of_word.at(-1)[2], /^.* … \d+ %$/);
  }
  await page.waitForFunction(() => !document.body.classList.contains('busy'));
  assert.equal(await page.$eval('#progress', (bar) => bar.hasAttribute('value')), false);
});

test('the mouse and keys move the view', async () => {
  const eye = async () => JSON.stringify((await ask('status')).scene.camera.eye);
  const box = await (await page.$('#canvas')).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  let last = await eye();
  const moved = async (how) => {
    await page.waitForTimeout(300);
    const now = await eye();
    assert.notEqual(now, last, how);
    last = now;
  };
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20, { steps: 4 });
  await page.mouse.up();
  await moved('dragging');
  await page.mouse.wheel(0, -200);
  await moved('the wheel');
  await page.focus('#canvas');
  await page.keyboard.press('ArrowLeft');
  await moved('an arrow');
  const method = (await ask('status')).scene.method;
  await page.keyboard.press('m');
  await page.waitForTimeout(500);
  assert.notEqual((await ask('status')).scene.method, method);
});

test('pointing at a pixel marks where each map is looked up', async () => {
  await set_scene((scene) => {
    scene.objects = [];
    scene.camera = { eye: [0, 0, 5], target: [0, 0, 0] };
    scene.method = 'cube';
  });
  const box = await (await page.$('#canvas')).boundingBox();
  await page.mouse.move(box.x + box.width / 2 - 1, box.y + box.height / 2);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => document.getElementById('look').textContent.startsWith('looks') &&
    !document.querySelector('.mark').hidden);
  // Straight ahead, -z, is the middle of the panorama, and of the cube's +Z, second in the cross.
  const place = async (map) => page.$eval(`[data-map="${map}"] .mark`, (mark) =>
    [Number.parseFloat(mark.style.left), Number.parseFloat(mark.style.top)]);
  const near = ([x, y], [u, v]) => assert.ok(Math.hypot(x - u, y - v) < 1, `${x}, ${y}`);
  near(await place('equirect'), [50, 50]);
  near(await place('cube'), [37.5, 50]);
  assert.match(await page.textContent('#look'), /looks \(−?0\.00, −?0\.00, −1\.00\)/);
  const painted = await page.$$eval('figure canvas', (all) => all.map((one) => one.width));
  assert.ok(painted.length === 5 && painted.every((width) => width > 50), String(painted));
});

// Fingers, each [x, y], along `paths` in some steps.
async function touch(session, paths, steps = 6) {
  const at = (share) => paths.map(([from, to], id) => ({ id, x: from[0] + share * (to[0] - from[0]),
    y: from[1] + share * (to[1] - from[1]) }));
  const send = (type, touchPoints) => session.send('Input.dispatchTouchEvent', { type, touchPoints });
  await send('touchStart', at(0));
  for (let i = 1; i <= steps; ++i) await send('touchMove', at(i / steps));
  await send('touchEnd', []);
}

test('fingers on a phone: one turns, two move and zoom, a tap marks, and every control is reached', async () => {
  const first = page;
  page = await open('#scene={"environment":{"source":"builtin:axes"},"objects":[{"mesh":"teapot","material":"chrome"}],"camera":{"eye":[0,1,5],"target":[0,0,0]}}',
    { viewport: kPhone, hasTouch: true, isMobile: true });
  await painted(page);
  const session = await page.context().newCDPSession(page);
  const camera = async () => {
    await page.waitForTimeout(300);
    const { eye, target = [0, 0, 0] } = (await ask('status')).scene.camera;
    const away = eye.map((x, i) => x - target[i]);
    const length = Math.hypot(...away);
    return { target, distance: length, direction: away.map((x) => x / length) };
  };
  const apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
  const box = await (await page.$('#canvas')).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];

  const start = await camera();
  await touch(session, [[[x, y], [x + 80, y + 15]]]);
  const turned = await camera();
  assert.ok(apart(turned.direction, start.direction) > 0.3, 'one finger turns');
  assert.ok(apart(turned.target, start.target) < 1e-6 && Math.abs(turned.distance / start.distance - 1) < 1e-6);
  assert.equal(await page.evaluate(() => scrollY), 0);

  // Twice as far from one another: twice as near.
  await touch(session, [[[x - 40, y], [x - 80, y]], [[x + 40, y], [x + 80, y]]]);
  const nearer = await camera();
  assert.ok(Math.abs(nearer.distance / turned.distance - 0.5) < 0.05, `${nearer.distance / turned.distance}`);
  assert.ok(apart(nearer.direction, turned.direction) < 1e-3);
  await touch(session, [[[x - 80, y], [x - 40, y]], [[x + 80, y], [x + 40, y]]]);
  const back = await camera();
  assert.ok(Math.abs(back.distance / turned.distance - 1) < 0.05);

  await touch(session, [[[x - 40, y], [x + 10, y + 30]], [[x + 40, y], [x + 90, y + 30]]]);
  const moved = await camera();
  assert.ok(apart(moved.target, back.target) > 0.1, 'two fingers move');
  assert.ok(apart(moved.direction, back.direction) < 1e-3 && Math.abs(moved.distance / back.distance - 1) < 0.02);

  await page.touchscreen.tap(x, y);
  await page.waitForFunction(() => [...document.querySelectorAll('.mark')].some((mark) => !mark.hidden));

  // Each control can be scrolled to, is large enough for a finger, and lies under nothing.
  const controls = await page.$$('#controls select, #controls input, #controls button, #controls summary');
  assert.ok(controls.length > 30);
  for (const control of controls) {
    if (!await control.isVisible() || await control.evaluate((one) => one.closest('[hidden]') !== null)) continue;
    const found = await control.evaluate((one) => {
      const target = one.matches('.hidden') ? one.closest('label') : one;
      target.scrollIntoView({ block: 'center' });
      const { x, y, width, height } = target.getBoundingClientRect();
      const there = document.elementFromPoint(x + width / 2, y + height / 2);
      const label = target.closest('label')?.getBoundingClientRect();
      return { name: one.id || one.textContent, hit: target === there || target.contains(there),
        size: Math.min(Math.max(width, label?.width ?? 0), Math.max(height, label?.height ?? 0)),
        inside: x >= 0 && x + width <= innerWidth };
    });
    assert.ok(found.hit && found.inside && found.size >= 32, JSON.stringify(found));
  }
  // The picture stays in sight, and a slider moves by touch.
  const slider = await page.$('#mirror');
  await slider.evaluate((one) => one.scrollIntoView({ block: 'center' }));
  const range = await slider.boundingBox();
  await page.touchscreen.tap(range.x + 0.25 * range.width, range.y + range.height / 2);
  await page.waitForFunction(() => Math.abs(document.getElementById('mirror').value - 0.25) < 0.06);
  assert.ok((await (await page.$('#canvas')).boundingBox()).y >= 0);
  await page.screenshot({ path: join(output, 'phone-slider.png') });
  await page.close();
  page = first;
});

test('it fits a phone and a desk, in the light and in the dark', async () => {
  for (const [name, viewport, colorScheme] of [['wide-light', kWide, 'light'], ['wide-dark', kWide, 'dark'],
    ['phone-light', kPhone, 'light'], ['phone-dark', kPhone, 'dark']]) {
    const one = await open('', { viewport, colorScheme, hasTouch: name.startsWith('phone') });
    await painted(one);
    await one.waitForFunction(() => document.body.dataset.smooth === 'true', null, { timeout: 60_000 });
    await one.waitForTimeout(1500);
    await one.screenshot({ path: join(output, `${name}.png`), fullPage: name.startsWith('phone') });
    const [across, there] = await one.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
    assert.ok(across <= there, `${name}: ${across} of ${there} pixels`);
    // Every control has a name.
    const nameless = await one.$$eval('input, select, button', (all) => all.filter((one) =>
      !one.closest('label') && !one.textContent && !one.getAttribute('aria-label')).length);
    assert.equal(nameless, 0);
    await one.close();
  }
});

test('nothing was complained about on the console', () => {
  assert.deepEqual(complaints, []);
});
