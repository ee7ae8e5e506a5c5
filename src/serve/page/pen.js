// Two pens that draw the same things: on a canvas, and as the text of an SVG file.
//
// Both know images, lines, boxes, discs and texts, in CSS pixels.

/** Draws on a canvas. */
export class CanvasPen {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {{size?: number[], style?: CSSStyleDeclaration}} [given] its size in CSS pixels and the
   *   style it takes, where it is not on the page
   */
  constructor(canvas, { size = [canvas.clientWidth, canvas.clientHeight], style } = {}) {
    const scale = window.devicePixelRatio || 1;
    [this.width, this.height] = size;
    const [w, h] = [Math.round(this.width * scale), Math.round(this.height * scale)];
    if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    this.context = canvas.getContext("2d");
    this.context.setTransform(scale, 0, 0, scale, 0, 0);
    this.style = style ?? getComputedStyle(canvas);
    // A file of it is looked at on any ground.
    this.box({ x: 0, y: 0, w: this.width, h: this.height }, { fill: this.colour("paper") });
  }

  /** A colour of the page's style. */
  colour(name) {
    return name === "ink" ? this.style.color : this.style.getPropertyValue(`--${name}`).trim();
  }

  /** What `draw` draws, only within a box. */
  within({ x, y, w, h }, draw) {
    const { context } = this;
    context.save();
    context.beginPath();
    context.rect(x, y, w, h);
    context.clip();
    draw();
    context.restore();
  }

  /** An image whose pixels stay sharp. Its rows go upwards here, beside one another. */
  image(canvas, { x, y, w, h }) {
    const { context } = this;
    context.save();
    context.imageSmoothingEnabled = false;
    context.transform(0, -h / canvas.width, w / canvas.height, 0, x, y + h);
    context.drawImage(canvas, 0, 0);
    context.restore();
  }

  /** A line through points [x0, y0, x1, y1, …]. */
  line(points, { colour, width = 1, dash = [] }) {
    const { context } = this;
    [context.strokeStyle, context.lineWidth] = [colour, width];
    context.setLineDash(dash);
    context.beginPath();
    for (let k = 0; k + 1 < points.length; k += 2) context.lineTo(points[k], points[k + 1]);
    context.stroke();
    context.setLineDash([]);
  }

  box({ x, y, w, h }, { fill, stroke }) {
    const { context } = this;
    if (fill) {
      context.fillStyle = fill;
      context.fillRect(x, y, w, h);
    }
    if (stroke) {
      [context.strokeStyle, context.lineWidth] = [stroke, 1];
      context.strokeRect(x, y, w, h);
    }
  }

  disc([x, y], radius, { fill, stroke, width = 1 }) {
    const { context } = this;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    if (fill) {
      context.fillStyle = fill;
      context.fill();
    }
    if (stroke) {
      [context.strokeStyle, context.lineWidth] = [stroke, width];
      context.stroke();
    }
  }

  text(words, [x, y], { colour, align = "center", base = "middle", size = 13, turned = false }) {
    const { context } = this;
    context.save();
    context.translate(x, y);
    if (turned) context.rotate(-Math.PI / 2);
    [context.fillStyle, context.textAlign, context.textBaseline] = [colour, align, base];
    context.font = `${size}px system-ui, sans-serif`;
    context.fillText(words, 0, 0);
    context.restore();
  }
}

const BASELINES = { middle: "0.35em", top: "0.8em", bottom: "-0.2em" };
const ANCHORS = { left: "start", center: "middle", right: "end" };
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const short = (x) => Number(x.toFixed(2));

/** Writes an SVG file of the same size as a canvas. */
export class SvgPen {
  /**
   * @param {number[]} size in CSS pixels
   * @param {CSSStyleDeclaration} style the colours
   */
  constructor(size, style) {
    [this.width, this.height] = size;
    this.style = style;
    this.parts = [];
    this.clips = 0;
  }

  colour(name) {
    return CanvasPen.prototype.colour.call(this, name);
  }

  within({ x, y, w, h }, draw) {
    const id = `clip${this.clips++}`;
    const box = `<rect x="${short(x)}" y="${short(y)}" width="${short(w)}" height="${short(h)}"/>`;
    this.parts.push(`<clipPath id="${id}">${box}</clipPath><g clip-path="url(#${id})">`);
    draw();
    this.parts.push("</g>");
  }

  image(canvas, { x, y, w, h }) {
    const turn = [0, -h / canvas.width, w / canvas.height, 0, x, y + h].map((n) =>
      Number(n.toFixed(6)),
    );
    const place = `width="${canvas.width}" height="${canvas.height}" transform="matrix(${turn.join(" ")})"`;
    this.parts.push(
      `<image ${place} preserveAspectRatio="none" image-rendering="pixelated" ` +
        `href="${canvas.toDataURL("image/png")}"/>`,
    );
  }

  line(points, { colour, width = 1, dash = [] }) {
    if (points.length < 4) return;
    const list = Array.from(points, short).join(" ");
    const dashes = dash.length ? ` stroke-dasharray="${dash.join(" ")}"` : "";
    this.parts.push(
      `<polyline points="${list}" fill="none" stroke="${escaped(colour)}" ` +
        `stroke-width="${width}"${dashes}/>`,
    );
  }

  box({ x, y, w, h }, { fill = "none", stroke = "none" }) {
    this.parts.push(
      `<rect x="${short(x)}" y="${short(y)}" width="${short(w)}" ` +
        `height="${short(h)}" fill="${escaped(fill)}" stroke="${escaped(stroke)}"/>`,
    );
  }

  disc([x, y], radius, { fill = "none", stroke = "none", width = 1 }) {
    this.parts.push(
      `<circle cx="${short(x)}" cy="${short(y)}" r="${radius}" ` +
        `fill="${escaped(fill)}" stroke="${escaped(stroke)}" stroke-width="${width}"/>`,
    );
  }

  text(words, [x, y], { colour, align = "center", base = "middle", size = 13, turned = false }) {
    const turn = turned ? " rotate(-90)" : "";
    this.parts.push(
      `<text transform="translate(${short(x)} ${short(y)})${turn}" ` +
        `dy="${BASELINES[base]}" text-anchor="${ANCHORS[align]}" font-size="${size}" ` +
        `fill="${escaped(colour)}">${escaped(words)}</text>`,
    );
  }

  /** The file. */
  file() {
    const { width: w, height: h } = this;
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${w}" height="${h}" ` +
      `viewBox="0 0 ${w} ${h}" font-family="system-ui, sans-serif">` +
      `<rect width="${w}" height="${h}" fill="${this.colour("paper")}"/>` +
      `${this.parts.join("\n")}</svg>\n`
    );
  }
}
