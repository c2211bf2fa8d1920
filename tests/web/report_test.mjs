// The viewer in a report that `mirrorball bake` wrote, opened as a file, in a real browser: it waits
// until it is looked at, is lit by the maps of the report, follows mouse, keys and controls, and asks
// for nothing but files of the report.
//
//     node --test report_test.mjs        with the variables of page_test.mjs
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { chromium } from 'playwright-core';

const page_folder = process.env.MIRRORBALL_PAGE;
const output = process.env.MIRRORBALL_OUTPUT ?? 'out';
mkdirSync(output, { recursive: true });
const kArguments = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader'];
const kSmall = { width: 900, height: 500 }, kDesk = { width: 1280, height: 800 }, kPhone = { width: 390, height: 844 };

// The program finds the page that was built, and no other, beside itself.
const folder = mkdtempSync(join(tmpdir(), 'mirrorball-report-'));
const program = join(folder, 'bin/mirrorball');
let browser;
const complaints = [], requests = [];

function bake(...args) {
  execFileSync(program, ['bake', ...args, '--quiet'], { cwd: folder });
}

// A panorama in floats, red ahead (-Z), green to the right, blue behind, white to the left, with a
// dark ground.
function four_walls() {
  const width = 256, height = 128, values = new Float32Array(width * height * 3);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const quarter = Math.floor(((x + 0.5) / width) * 4 + 0.5) % 4;  // behind, left, ahead, right
      const colour = [[0, 0, 1], [1, 1, 1], [1, 0, 0], [0, 1, 0]][quarter];
      // Rows of a .pfm begin at the bottom.
      const light = y < height / 4 ? 0.02 : 1;
      values.set(colour.map((c) => c * light), 3 * (y * width + x));
    }
  }
  return Buffer.concat([Buffer.from(`PF\n${width} ${height}\n-1.0\n`), Buffer.from(values.buffer)]);
}

async function open(report, options = {}) {
  const page = await browser.newPage({ viewport: kSmall, ...options });
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(pathToFileURL(join(folder, report, 'index.html')).href);
  return page;
}

const painted = (page) => page.waitForFunction(() => {
  const { drawn, smooth } = document.querySelector('.stage').dataset;
  return drawn && smooth === drawn;
}, null, { timeout: 90_000 });
async function start(page) {
  await page.locator('.stage').scrollIntoViewIfNeeded();
  await page.waitForFunction(
    () => ['live', 'failed'].includes(document.querySelector('.stage').dataset.state), null,
    { timeout: 90_000 });
  const { state, said } = await page.locator('.stage').evaluate((stage) => ({
    state: stage.dataset.state, said: stage.querySelector('button').textContent }));
  assert.equal(state, 'live', said);
  await painted(page);
}

// What a part of the picture shows: the mean of red, green and blue. Places are shares of the stage.
async function colour(page, x, y, size = 6) {
  const box = await page.locator('.stage').boundingBox();
  const clip = { x: box.x + x * box.width - size / 2, y: box.y + y * box.height - size / 2,
    width: size, height: size };
  const bytes = await page.screenshot({ clip });
  return page.evaluate(async (base64) => {
    const bitmap = await createImageBitmap(
      new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
    const surface = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    surface.drawImage(bitmap, 0, 0);
    const { data } = surface.getImageData(0, 0, bitmap.width, bitmap.height);
    const sums = [0, 0, 0];
    for (let i = 0; i < data.length; ++i) if (i % 4 < 3) sums[i % 4] += data[i];
    return sums.map((sum) => Math.round(sum / (data.length / 4)));
  }, bytes.toString('base64'));
}
const is_colour = (found, which, message) => {
  const [least, most] = [Math.min(...found.filter((_, i) => which[i])),
    Math.max(...found.filter((_, i) => !which[i]), 0)];
  assert.ok(least > 100 && most < 0.6 * least, `${message}: ${found}`);
};
const red = [1, 0, 0], green = [0, 1, 0], blue = [0, 0, 1], white = [1, 1, 1];

async function choose(page, name, value) {
  const control = page.locator(`.live [name=${name}]`);
  if (await control.evaluate((element) => element.tagName) === 'SELECT') await control.selectOption(value);
  else await control.fill(value);
  await painted(page);
}

before(async () => {
  mkdirSync(join(folder, 'bin'));
  mkdirSync(join(folder, 'share/mirrorball'), { recursive: true });
  copyFileSync(process.env.MIRRORBALL_PROGRAM, program);
  mkdirSync(join(folder, 'share/mirrorball/page'));
  copyFileSync(join(page_folder, 'embed.js'), join(folder, 'share/mirrorball/page/embed.js'));
  writeFileSync(join(folder, 'walls.pfm'), four_walls());
  bake('walls.pfm', '-o', 'walls', '--size', '64', '--phong', '20,200');
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: kArguments });
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test('the script is small', () => {
  const bytes = readFileSync(join(page_folder, 'embed.js'));
  console.log(`# embed.js: ${bytes.length} bytes, ${gzipSync(bytes, { level: 9 }).length} by gzip -9`);
  assert.ok(bytes.length < 2e6);
});

test('a still picture stands there until it is looked at, and the viewer begins with the same', async () => {
  const page = await open('walls', { viewport: { width: 1280, height: 500 } });
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => document.querySelector('.stage').dataset.state), undefined);
  assert.ok(!requests.some((url) => url.endsWith('viewer.js') || url.endsWith('maps.js')));
  await page.setViewportSize(kDesk);
  // Where the ball shows ahead, right, left and behind: in the still picture, then live.
  const places = [[0.5, 0.5], [0.08, 0.5], [0.92, 0.5], [0.5, 0.95]];
  const stage = page.locator('.stage');
  await page.evaluate(() => document.querySelector('.stage img').decode());
  const still = [];
  for (const [x, y] of places) {
    await stage.scrollIntoViewIfNeeded();
    still.push(await colour(page, x, y));
  }
  await start(page);
  for (const [i, [x, y]] of places.entries()) {
    const live = await colour(page, x, y);
    live.forEach((value, c) => assert.ok(Math.abs(value - still[i][c]) <= 12, `${x} ${y}: ${live}, still ${still[i]}`));
  }
  await page.close();
});

test('it is lit by what was baked, the right way round', async () => {
  const page = await open('walls');
  await start(page);
  // The camera looks ahead; the ball's middle shows what is behind it, its sides what is beside.
  is_colour(await colour(page, 0.06, 0.4), red, 'the background');
  is_colour(await colour(page, 0.5, 0.45), blue, 'the middle of a mirror ball');
  const { width, height } = await page.locator('.stage').boundingBox();
  const aside = 0.754 * Math.SQRT1_2 / 2 * height / width;  // there a ball mirrors what is beside it
  is_colour(await colour(page, 0.5 + aside, 0.48), green, 'right on a mirror ball');
  is_colour(await colour(page, 0.5 - aside, 0.48), white, 'left on a mirror ball');
  await choose(page, 'material', 'matte');
  const matte = await colour(page, 0.5, 0.48);
  assert.ok(matte[2] > 1.2 * matte[0], `a matte ball faces the blue wall: ${matte}`);
  await choose(page, 'material', 'phong');
  is_colour(await colour(page, 0.5, 0.45), blue, 'by Phong');
  await choose(page, 'material', 'gold');
  const gold = await colour(page, 0.5 + aside, 0.48);
  assert.ok(gold[1] > gold[2], `gold: ${gold}`);
  await page.close();
});

test('drag, keys and the wheel move it; one can go back to the front', async () => {
  const page = await open('walls');
  await start(page);
  const { x, y, width, height } = await page.locator('.stage').boundingBox();
  const drag = async (dx) => {
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + dx, y + height / 2, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(50);
    await painted(page);
  };
  // Half a turn in the picture's height. What is under the mouse goes with it: the eye to the left,
  // and it looks to the right.
  await drag(height / 2);
  is_colour(await colour(page, 0.06, 0.4), green, 'a quarter turn');
  is_colour(await colour(page, 0.5, 0.45), white, 'the ball then');
  await page.locator('[name=front]').click();
  await painted(page);
  is_colour(await colour(page, 0.06, 0.4), red, 'from the front again');
  await page.locator('.stage canvas').focus();
  for (let i = 0; i < 12; ++i) await page.keyboard.press('ArrowLeft');
  await page.waitForTimeout(50);
  await painted(page);
  is_colour(await colour(page, 0.06, 0.4), white, 'a quarter turn by keys');
  await page.keyboard.press('Home');
  const at = (scroll) => page.evaluate(() => scrollY);
  const before_wheel = await at();
  await page.mouse.move(x + width / 2, y + height / 2);
  for (let i = 0; i < 12; ++i) await page.mouse.wheel(0, -100);
  await page.waitForTimeout(100);
  await painted(page);
  assert.equal(await at(), before_wheel);
  is_colour(await colour(page, 0.2, 0.48), blue, 'the ball, so near that it covers this');
  await page.close();
});

test('each material says which file it looks up', async () => {
  const page = await open('walls');
  await start(page);
  const maps = () => page.locator('[data-of=maps]').textContent();
  assert.equal(await maps(), 'environment.ktx2');
  await choose(page, 'material', 'glossy');
  await choose(page, 'roughness', '0.5');
  assert.equal(await maps(), 'specular.ktx2, level 1');
  await choose(page, 'roughness', '0.75');
  assert.equal(await maps(), 'specular.ktx2, level 1.5');
  await choose(page, 'material', 'phong');
  await choose(page, 'exponent', '20');
  assert.equal(await maps(), 'phong.ktx2, level 1');
  for (const mesh of ['torus', 'teapot', 'cube', 'sphere']) {
    const before = await page.locator('.stage').screenshot();
    await choose(page, 'mesh', mesh);
    assert.notDeepEqual(await page.locator('.stage').screenshot(), before, mesh);
  }
  await choose(page, 'exposure', '-5');
  assert.ok(Math.max(...await colour(page, 0.06, 0.4)) < 90);
  await page.close();
});

test('several reports share one script', async () => {
  writeFileSync(join(folder, 'other.pfm'), four_walls());
  bake('walls.pfm', 'other.pfm', '-o', 'both', '--size', '32');
  assert.ok(existsSync(join(folder, 'both/viewer.js')));
  assert.ok(!existsSync(join(folder, 'both/walls/viewer.js')));
  const page = await open('both/other');
  await start(page);
  await page.close();
});

test('without its files the still picture stays, and says why', async () => {
  bake('walls.pfm', '-o', 'broken', '--size', '32');
  rmSync(join(folder, 'broken/maps.js'));
  const page = await browser.newPage({ viewport: kDesk });
  await page.goto(pathToFileURL(join(folder, 'broken/index.html')).href);
  await page.locator('.stage').scrollIntoViewIfNeeded();
  await page.waitForFunction(() => document.querySelector('.stage').dataset.state === 'failed');
  assert.equal(await page.locator('.stage button').textContent(), 'maps.js is not beside this page.');
  await page.close();
});

test('without scripts there is the picture alone', async () => {
  const context = await browser.newContext({ javaScriptEnabled: false, viewport: kDesk });
  const page = await context.newPage();
  await page.goto(pathToFileURL(join(folder, 'walls/index.html')).href);
  assert.ok(await page.locator('.stage img').isVisible());
  assert.ok(!await page.locator('.stage button').isVisible());
  await context.close();
});

test('it looks well on a desk and on a phone, light and dark', async () => {
  bake('builtin:studio', '-o', 'studio');
  console.log(`# maps.js: ${statSync(join(folder, 'studio/maps.js')).size} bytes`);
  for (const [name, viewport, scheme] of [['desk-light', kDesk, 'light'], ['desk-dark', kDesk, 'dark'],
    ['phone-light', kPhone, 'light'], ['phone-dark', kPhone, 'dark']]) {
    const page = await open('studio', { viewport, colorScheme: scheme });
    await page.locator('.live').evaluate((live) => live.parentElement.scrollIntoView());
    await start(page);
    if (scheme === 'dark') await choose(page, 'material', 'plastic');
    const { scroll, client } = await page.evaluate(() => ({
      scroll: document.documentElement.scrollWidth, client: document.documentElement.clientWidth }));
    assert.equal(scroll, client, `${name} is as wide as the window`);
    await page.screenshot({ path: join(output, `report-${name}.png`) });
    await page.close();
  }
});

test('nothing was complained about, nothing was asked of a network', () => {
  assert.deepEqual(complaints, []);
  assert.deepEqual(requests.filter((url) => !url.startsWith('file:') && !url.startsWith('data:')), []);
});
