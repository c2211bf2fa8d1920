// What scripts/page-pictures.sh asks for: the page on a desk and on a phone, and the frames of a little
// film: the view goes round, the roughness up and down, and a boundary between two methods to and fro.
//
//     MIRRORBALL_PAGE=FOLDER node page-pictures.mjs FOLDER_FOR_PICTURES
import { join } from 'node:path';
import { chromium } from 'playwright-core';
import { serve } from './server.mjs';

const folder = process.argv[2];
const kScene = (change = {}) => '#scene=' + JSON.stringify({
  environment: { source: 'builtin:sunset', yaw_degrees: -35 },
  objects: [{ mesh: 'teapot', material: 'copper' }],
  camera: { eye: [1.75, 0.95, 3.6], target: [0, -0.05, 0] }, ...change });
const server = await serve(process.env.MIRRORBALL_PAGE);
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox',
  '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });

// How long something took is another's time on another day.
const kSteady = '#frame-time, #facts:not(:has(#look:not(:empty))) { display: none !important; }';
async function open(scene, options) {
  const page = await browser.newPage(options);
  await page.goto(server.address + scene);
  await page.waitForFunction(() => document.body.dataset.painted, null, { timeout: 120_000 });
  await page.addStyleTag({ content: kSteady });
  await settled(page);
  return page;
}
// The picture is smooth, and nothing goes on.
async function settled(page) {
  await page.waitForFunction(() => document.body.dataset.smooth === 'true' &&
    !document.body.classList.contains('busy'), null, { timeout: 60_000 });
  await page.waitForTimeout(150);
}
// The same after a change, which is drawn before it is smooth.
async function change(page, act) {
  const count = await page.evaluate(() => Number(document.body.dataset.changes));
  await act();
  await page.waitForFunction((count) => Number(document.body.dataset.changes) > count, count);
  await settled(page);
}

const wide = await open(kScene(), { viewport: { width: 1280, height: 800 }, colorScheme: 'dark' });
const box = await (await wide.$('#canvas')).boundingBox();
await wide.mouse.move(box.x + 0.47 * box.width, box.y + 0.55 * box.height);
await wide.waitForTimeout(500);
await settled(wide);
await wide.screenshot({ path: join(folder, 'desktop.png') });
await wide.close();

const phone = await open(kScene({ camera: { eye: [2.1, 1.1, 4.3], target: [0, -0.05, 0] } }),
  { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true, colorScheme: 'dark' });
await phone.evaluate(() => document.getElementById('lobe-parameter').scrollIntoView({ block: 'end' }));
await settled(phone);
await phone.screenshot({ path: join(folder, 'phone.png') });
await phone.close();

const film = await open(kScene({ objects: [{ mesh: 'teapot', material: 'satin-gold' }] }),
  { viewport: { width: 940, height: 560 }, colorScheme: 'dark' });
let count = 0;
async function keep(act) {
  await change(film, act);
  await film.screenshot({ path: join(folder, `frame-${String(count++).padStart(3, '0')}.png`) });
}
const slide = (id, value) => film.evaluate(([id, value]) => {
  const input = document.getElementById(id);
  input.value = value;
  input.dispatchEvent(new Event('input', { bubbles: true }));
}, [id, value]);
const wave = (i, count) => 0.5 - 0.5 * Math.cos(2 * Math.PI * i / count);

const kTurns = 14;
for (let i = 0; i < kTurns; ++i) {
  const dx = i < kTurns / 2 ? 18 : -18;
  await keep(() => film.evaluate((dx) => mirrorball.ask('orbit', [dx, 0, 400]), dx));
}
await film.evaluate(() => document.getElementById('lobe-parameter').scrollIntoView({ block: 'center' }));
for (let i = 0; i < 14; ++i) {
  await keep(() => slide('lobe-parameter', 0.02 + 0.55 * wave(i, 14)));
}
await change(film, () => slide('lobe-parameter', 0.02));
await film.evaluate(() => document.getElementById('method').scrollIntoView({ block: 'center' }));
await change(film, () => film.selectOption('#showing', 'wipe'));
await change(film, () => film.selectOption('#other', 'sphere-vertex'));
for (let i = 0; i < 14; ++i) {
  await keep(() => slide('wipe', 0.15 + 0.7 * (1 - wave(i, 14))));
}
await browser.close();
server.close();
