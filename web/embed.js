// A viewer within another page, on that page's own thread: an object to turn, lit by maps that
// `mirrorball bake` has written. src/cli/report_viewer.cpp writes the elements that it brings to life,
// and src/web/embed.cpp, which stands above this in one script, is what draws.
//
//     await mirrorball_embed(element, maps)
//
// `element` has a .stage with a still picture in it, and a form of controls. `maps` has the files as
// base64 by name in `files`, the `exposure`, and what the levels of the specular chain stand for in
// `roughnesses`. Throws an Error that says why there is nothing to see; the still picture stays then.
async function mirrorball_embed(element, maps) {
  const stage = element.querySelector('.stage'), form = element.querySelector('form');
  const kSlow = 40, kQuick = 20, kLeastShare = 0.25, kRest = 200;  // milliseconds, and of a side
  const kKeyStep = 1 / 24, kMostPixelRatio = 2, kWheelStep = 100;

  const canvas = document.createElement('canvas');
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'application');
  canvas.setAttribute('aria-label', 'An object in the environment. Arrow keys turn it, plus and minus ' +
    'come nearer and go away, Home looks from the front.');

  const module = await load_mirrorball_embed();
  const handle = module.GL.createContext(canvas, { majorVersion: 2, minorVersion: 0, alpha: false,
    depth: true, stencil: false, antialias: false, enableExtensionsByDefault: true });
  if (!handle) throw new Error('This browser has no WebGL2, or it is switched off.');
  module.GL.makeContextCurrent(handle);
  const gl = module.GL.currentContext.GLctx;
  for (const name of ['EXT_color_buffer_float', 'OES_texture_float_linear', 'EXT_float_blend'])
    gl.getExtension(name);
  if (!gl.getExtension('EXT_color_buffer_float'))
    throw new Error('This graphics driver draws no half-float pictures.');

  // Whatever it calls answers with nothing, or with why it failed.
  function attempt(name, types, values) {
    const message = module.ccall(`mirrorball_${name}`, 'string', types, values);
    if (message) throw new Error(message);
  }
  const call = (name, ...numbers) =>
    module.ccall(`mirrorball_${name}`, null, numbers.map(() => 'number'), numbers);

  for (const [name, base64] of Object.entries(maps.files)) {
    const text = atob(base64);
    const place = module._malloc(text.length);
    for (let i = 0; i < text.length; ++i) module.HEAPU8[place + i] = text.charCodeAt(i);
    try {
      attempt('take', ['string', 'number', 'number'], [name, place, text.length]);
    } finally {
      module._free(place);
    }
  }
  attempt('open', ['number'], [maps.exposure]);

  // Drawing ------------------------------------------------------------------------------------------

  // While things change, as large as the machine draws in time; then whole, and smoother with each.
  let share = 0.5, scheduled = false, resting = 0, height = 1;

  function size(share) {
    const ratio = Math.min(devicePixelRatio, kMostPixelRatio) * share;
    height = Math.max(1, stage.clientHeight);
    const wanted = [stage.clientWidth, height].map((side) => Math.max(1, Math.round(side * ratio)));
    if (canvas.width !== wanted[0]) canvas.width = wanted[0];
    if (canvas.height !== wanted[1]) canvas.height = wanted[1];
  }
  function draw(share) {
    const start = performance.now();
    size(share);
    attempt('draw', ['number', 'number'], [canvas.width, canvas.height]);
    // Waits for the picture: the time is that of all of it.
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - start;
  }
  function give_up(error) {
    scheduled = true;  // for good
    canvas.remove();
    stage.dataset.state = 'failed';
    stage.querySelector('button').textContent = error.message ?? String(error);
    form.querySelector('fieldset').disabled = true;
  }
  function guarded(act) {
    return (...values) => {
      try {
        return act(...values);
      } catch (error) {
        give_up(error);
      }
    };
  }
  const tick = guarded(() => {
    scheduled = false;
    const milliseconds = draw(share);
    stage.dataset.drawn = Number(stage.dataset.drawn ?? 0) + 1;
    if (milliseconds > kSlow)
      share = Math.max(kLeastShare, share * Math.max(0.5, Math.sqrt(kSlow / milliseconds) * 0.9));
    else if (milliseconds < kQuick)
      share = Math.min(1, share * 1.25);
    clearTimeout(resting);
    resting = setTimeout(rest, share < 1 ? kRest : 0);
  });
  const rest = guarded(() => {
    if (scheduled) return;
    draw(1);
    if (module.ccall('mirrorball_is_smooth', 'boolean', [], []))
      stage.dataset.smooth = stage.dataset.drawn;
    else
      resting = setTimeout(rest, 0);
  });
  function changed() {
    stage.dataset.smooth = '';
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(tick);
  }

  // Controls -----------------------------------------------------------------------------------------

  const values = form.elements;
  const has_roughness = (material) => !['mirror', 'phong', 'matte'].includes(material);

  // "level 1.4" of the chain, for a roughness.
  function level_of(roughness) {
    const all = maps.roughnesses;
    let i = 0;
    while (i + 2 < all.length && all[i + 1] <= roughness) ++i;
    const level = i + Math.min(1, Math.max(0, (roughness - all[i]) / (all[i + 1] - all[i])));
    return `level ${Number(level.toFixed(2))}`;
  }
  function what_is_read() {
    const material = values.material.value;
    if (material === 'mirror') return 'environment.ktx2';
    if (material === 'matte') return 'diffuse.ktx2';
    if (material === 'phong') return `phong.ktx2, level ${values.exponent.selectedIndex}`;
    const specular = `specular.ktx2, ${level_of(values.roughness.valueAsNumber)}`;
    return material === 'plastic' ? `${specular}, and diffuse.ktx2` : specular;
  }
  const show = guarded(() => {
    const material = values.material.value;
    const number = material === 'phong' ? Number(values.exponent.value) : values.roughness.valueAsNumber;
    const stops = values.exposure.valueAsNumber;
    values.roughness.closest('label').hidden = !has_roughness(material);
    values.exponent.closest('label').hidden = material !== 'phong';
    form.querySelector('[data-of=roughness]').textContent = values.roughness.valueAsNumber.toFixed(2);
    form.querySelector('[data-of=exposure]').textContent = `${stops > 0 ? '+' : ''}${stops} stops`;
    form.querySelector('[data-of=maps]').textContent = what_is_read();
    attempt('show', ['string', 'string', 'number', 'number'],
      [values.mesh.value, material, number, stops]);
    changed();
  });
  const move = guarded((name, ...numbers) => {
    call(name, ...numbers);
    changed();
  });
  form.addEventListener('input', show);
  form.addEventListener('submit', (event) => event.preventDefault());
  values.front.addEventListener('click', () => move('face'));

  // One pointer turns, two come nearer. The wheel, and a finger that goes up or down, are the page's
  // until the picture has been touched.
  const pointers = new Map();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    const was_apart = pointers.size === 2 ? spread() : 0;
    pointers.set(event.pointerId, now);
    if (pointers.size === 1) move('orbit', now.x - before.x, now.y - before.y, height);
    if (was_apart > 0) move('zoom', Math.log(spread() / was_apart) / Math.log(1.12));
  });
  for (const end of ['pointerup', 'pointercancel'])
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener('wheel', (event) => {
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    move('zoom', -event.deltaY * (event.deltaMode ? 33 : 1) / kWheelStep);
  }, { passive: false });
  const keys = {
    ArrowLeft: ['orbit', -kKeyStep, 0, 1], ArrowRight: ['orbit', kKeyStep, 0, 1],
    ArrowUp: ['orbit', 0, -kKeyStep, 1], ArrowDown: ['orbit', 0, kKeyStep, 1],
    '+': ['zoom', 1], '=': ['zoom', 1], '-': ['zoom', -1], Home: ['face'],
  };
  canvas.addEventListener('keydown', (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    move(...keys[event.key]);
  });
  canvas.addEventListener('webglcontextlost',
    () => give_up(new Error('The graphics driver took its pictures back. Load the page again.')));

  show();
  draw(share);
  form.querySelector('fieldset').disabled = false;
  stage.append(canvas);
  stage.dataset.state = 'live';
  new ResizeObserver(changed).observe(stage);
}
