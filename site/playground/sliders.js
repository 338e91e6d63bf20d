// Sliders for the uncertain keys and for the number under the cursor. A moved slider writes its number into the text.

import { written } from "./toml.js";

// So many at once; the others are behind "more".
const SHOWN = 5;

export class Sliders {
  constructor(parent, editor, onend) {
    Object.assign(this, { parent, editor, onend, uncertain: [], current: null, isMoving: false });
  }

  // Takes the ranges of the uncertain keys, which are in SI units; a number of the text may be in another.
  setUncertain(all) {
    this.uncertain = all.flatMap((own) => {
      const number = this.editor.numberFrom(own.line, own.column);
      if (!number || !own.nominal) return [];
      const factor = number.value / own.nominal;
      const [low, high] = [own.range[0] * factor, own.range[1] * factor].sort((a, b) => a - b);
      // The value of a table that names the key elsewhere is not its number.
      if (!(low < high) || number.value < low - 0.5 * (high - low) || number.value > high + 0.5 * (high - low)) return [];
      const find = () => this.editor.numberFrom(own.line, own.column);
      return [{ label: own.key, unit: number.unit, low, high, value: number.value, find }];
    });
    this.draw();
  }

  // Takes the number under the cursor: from half to double.
  setCurrent(number) {
    if (this.isMoving) return;
    const place = number && number.value !== 0 ? number : null;
    if (!place && !this.current) return;
    this.current = place && {
      label: place.key || "number under the cursor",
      unit: place.unit,
      low: Math.min(place.value / 2, place.value * 2),
      high: Math.max(place.value / 2, place.value * 2),
      value: place.value,
      find: () => this.editor.number(),
    };
    this.draw();
  }

  draw() {
    this.parent.replaceChildren();
    const all = [this.current, ...this.uncertain].filter(Boolean);
    const rows = all.map((own) => this.row(own));
    this.parent.append(...rows.slice(0, SHOWN));
    if (rows.length > SHOWN) {
      const more = document.createElement("details");
      const summary = document.createElement("summary");
      summary.textContent = `${rows.length - SHOWN} more`;
      more.append(summary, ...rows.slice(SHOWN));
      this.parent.append(more);
    }
  }

  row(own) {
    const label = document.createElement("label");
    const name = document.createElement("span");
    const output = document.createElement("output");
    const input = document.createElement("input");
    name.textContent = own.label;
    Object.assign(input, { type: "range", min: own.low, max: own.high, step: (own.high - own.low) / 200, value: own.value });
    input.setAttribute("aria-label", own.label);
    const show = (value) => (output.textContent = `${written(value)} ${own.unit}`.trim());
    show(own.value);
    input.oninput = () => {
      this.isMoving = true;
      const value = Number(input.value);
      show(value);
      const place = own.find();
      if (place) this.editor.replace(place.from, place.to, written(value));
    };
    input.onchange = () => {
      this.isMoving = false;
      this.onend();
    };
    label.append(name, input, output);
    return label;
  }
}
