// The heat map of plotly.js, as benches/explorer/peers.mjs drives it.

window.peer = {
  /** Draws the first chart. Rows are prepared for all steps: a step only hands them over. */
  async begin({ nx, ny, charts, x, y }) {
    const row = (cells, j) => cells.subarray(j * nx, (j + 1) * nx);
    const rows = (cells) => Array.from({ length: ny }, (_, j) => row(cells, j));
    this.charts = charts.map(rows);
    const most = charts.reduce((all, cells) => cells.reduce((a, b) => Math.max(a, b), all), 0);
    const step = ([from, to], n) => (to - from) / n;
    this.heat = {
      type: "heatmap", zmin: 0, zmax: most, zauto: false, colorscale: "Viridis",
      x0: x[0] + step(x, nx) / 2, dx: step(x, nx), y0: y[0] + step(y, ny) / 2, dy: step(y, ny),
    };
    this.layout = { margin: { l: 64, r: 16, t: 10, b: 46 } };
    await window.Plotly.newPlot("chart", [{ ...this.heat, z: this.charts[0] }], this.layout);
  },

  /** Shows one of the charts; resolved when it is drawn. */
  async show(k) {
    await window.Plotly.react("chart", [{ ...this.heat, z: this.charts[k] }], this.layout);
  },
};
