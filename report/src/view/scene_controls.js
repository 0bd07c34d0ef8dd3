import { MOUSE, TOUCH, Vector2, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

/** Turning, moving and zooming by pointer, finger and key. @param {import('./scene3d.js').Scene3d} scene */
export function orbit(scene) {
  const { canvas } = scene;
  const controls = new OrbitControls(scene.camera, canvas);
  controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
  controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
  controls.addEventListener('change', () => scene.request());
  controls.addEventListener('start', () => (scene.turned = true));
  // The wheel scrolls the page until the picture has been clicked; a finger moved up or down scrolls it, too.
  controls.enableZoom = false;
  canvas.style.touchAction = 'pan-y';
  canvas.tabIndex = 0;
  canvas.addEventListener('pointerdown', (event) => {
    controls.enableZoom = true;
    if (event.pointerType !== 'touch') canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener('blur', () => (controls.enableZoom = false));
  canvas.addEventListener('keydown', (event) => byKey(event, scene));
  return controls;
}

/** Arrows turn, plus and minus zoom. @param {KeyboardEvent} event @param {import('./scene3d.js').Scene3d} scene */
function byKey(event, { camera, controls }) {
  const turns = { ArrowLeft: [0.12, 0], ArrowRight: [-0.12, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  const zooms = { '+': 0.85, '=': 0.85, '-': 1 / 0.85 };
  const offset = camera.position.clone().sub(controls.target);
  if (turns[event.key]) {
    const [around, up] = turns[event.key];
    offset.applyAxisAngle(new Vector3(0, 0, 1), around);
    const side = new Vector3().crossVectors(new Vector3(0, 0, 1), offset).normalize();
    const raised = offset.clone().applyAxisAngle(side, -up);
    if (Math.abs(raised.z) < 0.995 * raised.length()) offset.copy(raised);
  } else if (zooms[event.key]) offset.multiplyScalar(zooms[event.key]);
  else return;
  event.preventDefault();
  camera.position.copy(controls.target).add(offset);
  controls.update();
}

/**
 * A click, not the end of a drag.
 * @param {import('./scene3d.js').Scene3d} scene @param {(at: Vector2) => void} click place from −1 to 1
 */
export function onClick({ canvas }, click) {
  let down = null;
  canvas.addEventListener('pointerdown', (event) => (down = [event.clientX, event.clientY]));
  canvas.addEventListener('pointerup', (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5) return;
    const box = canvas.getBoundingClientRect();
    const x = (2 * (event.clientX - box.left)) / box.width - 1;
    click(new Vector2(x, 1 - (2 * (event.clientY - box.top)) / box.height));
  });
}
