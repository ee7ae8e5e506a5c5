// Pointer and keys on a plane: a point is chosen, the view is moved and zoomed.

/** A pointer that moves less than this far, in CSS pixels, chooses a point. */
const STILL = 4;
/** How much a key or a button zooms. */
export const ZOOM = 1.5;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** The view zoomed about a point, by its parts; more than 1 shows less. */
export function zoomed(view, parts, factor) {
  return view.map((scale, axis) => {
    const [part, size] = [parts[axis], 1 / factor];
    return scale.between(part - part * size, part + (1 - part) * size);
  });
}

/** The view moved by parts of itself. */
export const moved = (view, by) => view.map((scale, axis) => scale.between(by[axis], 1 + by[axis]));

/**
 * Follows what is done on the canvas of a plane.
 * @param {import("./plane.js").PlaneView} plane
 * @param {{look: (point: number[]) => void, move: (point: number[]) => void,
 *   hover: (point: number[] | null, place?: {x: number, y: number}) => void, view: (view: object[] | null) => void}} told
 *   a null view is that of the beginning
 */
export function follow(plane, told) {
  const { canvas } = plane;
  const pointers = new Map();
  let [began, view, far] = [null, null, false];
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const middle = () => {
    const all = [...pointers.values()];
    return [0, 1].map((axis) => all.reduce((sum, p) => sum + p[axis], 0) / all.length);
  };
  const spread = () => {
    const [p, q] = [...pointers.values()];
    return q ? Math.max(20, Math.hypot(p[0] - q[0], p[1] - q[1])) : 1;
  };
  const restart = () => {
    began = pointers.size ? { middle: middle(), spread: spread() } : null;
    view = plane.view;
  };
  const partsOf = ([x, y]) => {
    const area = plane.area();
    return [(x - area.x) / area.w, 1 - (y - area.y) / area.h];
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !plane.view) return;
    canvas.setPointerCapture(event.pointerId);
    if (pointers.size === 0) far = false;
    pointers.set(event.pointerId, at(event));
    restart();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!plane.view) return;
    if (!pointers.has(event.pointerId)) {
      const [x, y] = at(event);
      return told.hover(plane.valueAt(x, y), { x, y });
    }
    pointers.set(event.pointerId, at(event));
    const [now, before] = [partsOf(middle()), partsOf(began.middle)];
    const [x, y] = middle();
    far ||= pointers.size > 1 || Math.hypot(x - began.middle[0], y - began.middle[1]) > STILL;
    if (!far) return;
    const factor = spread() / began.spread;
    told.view(zoomed(moved(view, [before[0] - now[0], before[1] - now[1]]), now, factor));
  });
  const up = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    restart();
    if (event.type === "pointerup" && !far && pointers.size === 0) {
      told.look(plane.valueAt(...at(event)));
    }
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => told.hover(null));
  canvas.addEventListener("dblclick", (event) => {
    if (!plane.view) return;
    told.view(zoomed(plane.view, partsOf(at(event)), event.shiftKey ? 1 / ZOOM : ZOOM));
  });
  // The wheel scrolls the page until the chart is used.
  canvas.addEventListener(
    "wheel",
    (event) => {
      if (!plane.view || !(event.ctrlKey || document.activeElement === canvas)) return;
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 16 : 1;
      told.view(zoomed(plane.view, partsOf(at(event)), Math.exp(-0.002 * lines * event.deltaY)));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    if (event.altKey || event.metaKey || event.ctrlKey || !plane.view) return;
    const done = key(plane, told, event);
    if (done) event.preventDefault();
  });
}

/** Does what a key says; whether it says something. */
function key(plane, told, event) {
  const { view, point } = plane;
  const about = () => (point ? view.map((scale, axis) => scale.part(point[axis])) : [0.5, 0.5]);
  const centre = about().every((part) => part >= 0 && part <= 1) ? about() : [0.5, 0.5];
  switch (event.key) {
    case "Enter":
    case " ":
      if (point) told.look(point);
      return true;
    case "+":
    case "=":
      told.view(zoomed(view, centre, ZOOM));
      return true;
    case "-":
      told.view(zoomed(view, centre, 1 / ZOOM));
      return true;
    case "0":
      told.view(null);
      return true;
    default:
  }
  const step = ARROWS[event.key];
  if (!step || !point) return false;
  const share = event.shiftKey ? 0.1 : 0.01;
  told.move(
    view.map((scale, axis) => {
      const part = scale.part(point[axis]) + share * step[axis];
      return scale.value(Math.min(1, Math.max(0, part)));
    }),
  );
  return true;
}
