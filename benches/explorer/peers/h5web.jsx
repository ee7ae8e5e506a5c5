// The heat map of h5web, as benches/explorer/peers.mjs drives it. Bundled by esbuild.

import { HeatmapVis } from "@h5web/lib";
import "@h5web/lib/styles.css";
import { useFrame } from "@react-three/fiber";
import ndarray from "ndarray";
import { useRef } from "react";
import { createRoot } from "react-dom/client";

/** Says which picture is drawn in each frame. */
function Drawn({ number, told }) {
  const last = useRef(null);
  useFrame(({ gl }) => {
    const anew = last.current !== number;
    last.current = number;
    told(number, anew, gl);
  });
  return null;
}

/** Names of axes at the edges of all cells. */
const axis = ([from, to], n, label) =>
  ({ label, value: Array.from({ length: n + 1 }, (_, i) => from + ((to - from) * i) / n) });

window.peer = {
  draw(number, array, told) {
    const { domain, across, upwards } = this;
    this.root.render(
      <HeatmapVis
        style={{ width: "100%", height: "100%" }}
        dataArray={array}
        domain={domain}
        colorMap="Viridis"
        aspect="auto"
        abscissaParams={across}
        ordinateParams={upwards}
      >
        <Drawn number={number} told={told} />
      </HeatmapVis>,
    );
  },

  /** Draws the first chart. Arrays of all steps are of a type that becomes a texture as it is. */
  async begin({ nx, ny, charts, x, y }) {
    const most = charts.reduce((all, cells) => cells.reduce((a, b) => Math.max(a, b), all), 0);
    this.arrays = charts.map((cells) => ndarray(Float32Array.from(cells), [ny, nx]));
    this.domain = [0, most];
    [this.across, this.upwards] = [axis(x, nx, "α_v"), axis(y, ny, "τ")];
    this.root = createRoot(document.getElementById("chart"));
    this.number = 0;
    await this.show(0);
  },

  /** Shows one of the charts; resolved when it is drawn. */
  show(k) {
    return new Promise((done) => {
      const number = ++this.number;
      this.draw(number, this.arrays[k], (drawn, anew) => anew && drawn === number && done());
    });
  },

  /** One large array that stays; `told` is called when a view of it is on the screen. */
  still({ nx, ny, cells, most }, told) {
    this.domain = [0, most];
    [this.across, this.upwards] = [axis([0, nx], nx, "x"), axis([0, ny], ny, "y")];
    this.root = createRoot(document.getElementById("chart"));
    const array = ndarray(cells, [ny, nx]);
    this.draw(1, array, (number, anew, gl) => {
      // The picture is drawn behind this call, by another process: reading a pixel waits for it.
      requestAnimationFrame(() => {
        const context = gl.getContext();
        context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
        told();
      });
    });
  },
};
