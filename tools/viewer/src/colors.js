// Colours of vertices, and the legend beside them.

const stops = {
  heat: [[0.19, 0.07, 0.36], [0.19, 0.40, 0.64], [0.13, 0.67, 0.56], [0.66, 0.85, 0.32], [0.99, 0.91, 0.45]],
  signed: [[0.12, 0.33, 0.66], [0.55, 0.74, 0.88], [0.95, 0.95, 0.94], [0.93, 0.62, 0.48], [0.70, 0.11, 0.17]],
};
const contactColors = [[0.56, 0.74, 0.85], [0.98, 0.78, 0.36], [0.80, 0.16, 0.20]];
const plain = [0.34, 0.62, 0.78];

function ramp(colors, t, out, at) {
  const x = Math.min(Math.max(t, 0), 1) * (colors.length - 1), k = Math.min(Math.floor(x), colors.length - 2), f = x - k;
  for (let c = 0; c < 3; ++c) out[at + c] = linear(colors[k][c] * (1 - f) + colors[k + 1][c] * f);
}
const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);  // sRGB to what the renderer adds up

function hue(drop) {  // well apart for neighbouring numbers
  const h = (drop * 0.61803398875 + 0.55) % 1;
  return [0, 1, 2].map((c) => 0.52 + 0.33 * Math.cos(2 * Math.PI * (h - c / 3)));
}

const css = (color) => `rgb(${color.map((c) => Math.round(255 * c)).join(" ")})`;
const number = (x) => (Math.abs(x) >= 100 ? x.toFixed(0) : x.toPrecision(3));

function rampLegend(title, colors, low, high) {
  const steps = colors.map(css).join(", ");
  return `<div>${title}</div><div class="ramp" style="background: linear-gradient(90deg, ${steps})"></div>
    <div class="ends"><span>${number(low)}</span><span>${number(high)}</span></div>`;
}

/** The value below which 98 of 100 magnitudes lie. */
function commonMagnitude(values) {
  const sorted = Float32Array.from(values, Math.abs).sort();
  return sorted[Math.floor(0.98 * (sorted.length - 1))] || 0;
}

/** Fills `out` (3 a vertex, linear) with what `look` shows of a surface; returns the legend's HTML. */
export class Colors {
  constructor(maxSpeed) {
    this.maxSpeed = maxSpeed || 1;
    this.maxCurvature = 0;  // grows over the frames that were shown, so that colours keep their meaning
  }

  fill(look, surface, frame, curvatureOf, out) {
    const n = frame.vertices;
    if (look === "speed") {
      const scale = frame.speed / 255 / this.maxSpeed;
      for (let v = 0; v < n; ++v) ramp(stops.heat, surface.speed[v] * scale, out, 3 * v);
      return rampLegend("speed, cm/s", stops.heat, 0, this.maxSpeed);
    }
    if (look === "curvature") {
      const k = curvatureOf();
      this.maxCurvature = Math.max(this.maxCurvature, commonMagnitude(k)) || 1;
      for (let v = 0; v < n; ++v) ramp(stops.signed, 0.5 + 0.5 * k[v] / this.maxCurvature, out, 3 * v);
      return rampLegend("curvature &kappa;<sub>1</sub> + &kappa;<sub>2</sub>, 1/cm", stops.signed, -this.maxCurvature, this.maxCurvature);
    }
    const of = look === "drop" ? (v) => hue(surface.drop[v]) : look === "contact" ? (v) => contactColors[surface.contact[v]] ?? plain : () => plain;
    for (let v = 0; v < n; ++v) {
      const color = of(v);
      for (let c = 0; c < 3; ++c) out[3 * v + c] = linear(color[c]);
    }
    if (look !== "contact") return "";
    return ["free", "wetted", "contact line"].map((name, k) => `<div><span class="swatch" style="background: ${css(contactColors[k])}"></span>${name}</div>`).join("");
  }
}
