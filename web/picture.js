// The picture and the maps below it: by mouse, fingers and keys.
import { step_environment } from './controls.js';
import { $, ask, ask_newest, show_error } from './library.js';
import { facts, refresh, remember } from './shown.js';

export const canvas = $('canvas');

export const aspect = () => canvas.clientWidth / Math.max(1, canvas.clientHeight);
export const canvas_size = () => {
  const ratio = Math.min(devicePixelRatio || 1, 2);
  return [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
};

export function show_frame(frame) {
  if (frame.error) return show_error(frame.error);
  $('frame-time').textContent = `${frame.milliseconds.toFixed(0)} ms`;
  if (frame.changed) document.body.dataset.changes = frame.count;
  document.body.dataset.smooth = frame.smooth;
}

// By hand ----------------------------------------------------------------------------------------

export function wire_picture() {
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
    // Fingers cannot point without touching.
    if (event.pointerType === 'touch') look_at(event);
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
  canvas.addEventListener('pointerleave', (event) => { if (event.pointerType === 'mouse') hide_marks(); });

  addEventListener('keydown', (event) => {
    const elsewhere = event.target !== canvas && event.target !== document.body;
    if (elsewhere || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === 'Escape') return show_error('');
    if (!known_keys(event.key)) return;
    event.preventDefault();
    if (event.key.toLowerCase() === 'e') return step_environment(event.key === 'e' ? 1 : -1);
    ask('press', [event.key, aspect()]).then(refresh, () => {});
  });
  $('frame').addEventListener('click', () => ask('frame_all', [aspect()]).then(remember));
  $('map-content').addEventListener('change', show_maps);

  new ResizeObserver(() => ask_newest('size', () => ask('resize', canvas_size()))).observe(canvas);
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
function hide_marks() {
  $('look').textContent = '';
  for (const mark of document.querySelectorAll('.mark')) mark.hidden = true;
}

// Maps -------------------------------------------------------------------------------------------

export function show_maps() {
  const height = 90 * Math.min(Math.ceil(devicePixelRatio || 1), 2);
  ask('show_maps', [{ content: $('map-content').value, height,
    projections: facts.projections.map((projection) => projection.name) }]);
}

export function show_map({ projection, picture }) {
  const surface = document.querySelector(`[data-map="${projection}"] canvas`);
  surface.width = picture.width;
  surface.height = picture.height;
  surface.getContext('2d').putImageData(picture, 0, 0);
}

export function make_map_list() {
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
