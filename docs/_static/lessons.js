// The live lessons: sliders choose among responses that the library has computed, and uPlot draws them.
//
// A page holds <section class="lesson" data-lesson="pi"> with its inputs, and loads window.loopbookLessons.pi:
//   counts, start    how many positions each slider has, and which is the first
//   answers          for each position of all the sliders: [verdict, results, numbers of lines, marks]
//   lines            the responses, two letters a value, see decode
"use strict";

(() => {
  const ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  const DIGIT = Object.fromEntries([...ALPHABET].map((letter, value) => [letter, value]));
  const TOP = ALPHABET.length ** 2 - 1;
  const ROOM = 0.5; // the letters reach that many heights of the axis below and above it
  const HEIGHT = 210; // of a picture, in pixels, without its axis

  function decode(text, low, high) {
    const values = new Array(text.length / 2);
    const step = ((1 + 2 * ROOM) * (high - low)) / TOP;
    for (let k = 0; k < values.length; k++) {
      values[k] = low - ROOM * (high - low) + step * (64 * DIGIT[text[2 * k]] + DIGIT[text[2 * k + 1]]);
    }
    return values;
  }

  const night = window.matchMedia("(prefers-color-scheme: dark)");

  function isDark() {
    const chosen = document.body.dataset.theme; // Furo's switch
    return chosen === "dark" || (chosen !== "light" && night.matches);
  }

  function ink(name) {
    return getComputedStyle(document.body).getPropertyValue(name).trim();
  }

  function element(name, html) {
    const made = document.createElement(name);
    made.innerHTML = html;
    return made;
  }

  class Lesson {
    constructor(section, data) {
      this.section = section;
      this.data = data;
      this.inputs = [...section.querySelectorAll(".lesson-slider input, .lesson-slider select")];
      this.places = [...section.querySelectorAll(".lesson-plot")];
      this.result = section.querySelector(".lesson-result");
      this.keep = section.querySelector(".lesson-keep");
      this.kept = null; // the numbers of the lines that stay for comparison
      const { from, to, count } = data.time;
      this.times = Array.from({ length: count }, (_, k) => from + ((to - from) * k) / (count - 1));
      this.plots = data.panels.map((panel, number) => this.plot(panel, number));
      for (const input of this.inputs) input.addEventListener("input", () => this.show());
      section.querySelector(".lesson-buttons").hidden = false;
      section.querySelector(".lesson-reset").addEventListener("click", () => this.reset());
      this.keep.addEventListener("click", () => this.toggleKept());
      new ResizeObserver(() => this.fit()).observe(section);
      this.show();
    }

    get answer() {
      const positions = this.inputs.map((input) => Number(input.value));
      return this.data.answers[positions.reduce((sum, k, slider) => sum * this.data.counts[slider] + k, 0)];
    }

    curvesOf(number) {
      return this.data.curves.map((curve, k) => ({ ...curve, k })).filter((curve) => curve.panel === number);
    }

    plot(panel, number) {
      const curves = this.curvesOf(number);
      const colour = (curve) => () => (isDark() ? curve.dark : curve.light);
      const axis = {
        stroke: () => ink("--color-foreground-primary"),
        grid: { stroke: () => ink("--color-background-border"), width: 1 },
        ticks: { show: false },
        font: "13px system-ui, sans-serif",
        labelFont: "13px system-ui, sans-serif",
      };
      const last = number === this.data.panels.length - 1;
      const options = {
        width: 300,
        height: HEIGHT + (last ? 45 : 25),
        padding: [8, 12, 0, 0],
        legend: { show: false },
        cursor: { show: false },
        scales: { x: { time: false }, y: { range: [panel.low, panel.high] } },
        axes: [
          { ...axis, size: last ? 28 : 26, label: last ? this.data.clock : undefined, labelSize: 20 },
          { ...axis, size: 46, label: panel.axis, labelSize: 20 },
        ],
        series: [
          {},
          ...curves.map(() => ({ stroke: () => ink("--color-foreground-border"), width: 3, points: { show: false } })),
          ...curves.map((curve) => ({
            stroke: colour(curve),
            width: curve.width,
            dash: curve.dash,
            points: { show: false },
          })),
        ],
        hooks: { draw: [(plot) => this.drawMarks(plot, number)] },
      };
      return new uPlot(options, undefined, this.places[number]);
    }

    // A dot, a line down to the axis, and a label beside.
    drawMarks(plot, number) {
      const { ctx } = plot;
      const ratio = window.devicePixelRatio;
      ctx.save();
      ctx.fillStyle = ctx.strokeStyle = ink("--color-foreground-primary");
      ctx.font = `${13 * ratio}px system-ui, sans-serif`;
      ctx.textAlign = "left";
      ctx.setLineDash([3 * ratio, 3 * ratio]);
      for (const [panel, time, value, label] of this.answer[3]) {
        if (panel !== number) continue;
        const x = plot.valToPos(time, "x", true);
        const y = plot.valToPos(value, "y", true);
        ctx.beginPath();
        ctx.moveTo(x, y);
        ctx.lineTo(x, plot.bbox.top + plot.bbox.height);
        ctx.stroke();
        ctx.beginPath();
        ctx.arc(x, y, 4 * ratio, 0, 2 * Math.PI);
        ctx.fill();
        ctx.fillText(label, x + 7 * ratio, label.startsWith("under") ? y + 16 * ratio : y - 6 * ratio);
      }
      ctx.restore();
    }

    show() {
      const [verdict, results, lines] = this.answer;
      for (const input of this.inputs.filter((one) => one.dataset.texts)) {
        const text = JSON.parse(input.dataset.texts)[input.value];
        input.setAttribute("aria-valuetext", text);
        input.parentElement.querySelector("output").textContent = text;
      }
      const pairs = this.data.results.map((label, k) => element("span", `${label} <b>${results[k]}</b>`));
      this.result.replaceChildren(element("strong", `${verdict}.`), ...pairs.flatMap((pair) => [" ", pair]));
      const told = `${verdict}; ${pairs.map((pair) => pair.textContent).join(", ")}`;
      this.plots.forEach((plot, number) => {
        const panel = this.data.panels[number];
        const curves = this.curvesOf(number);
        const values = (line) => (line < 0 ? this.times.map(() => null) : decode(this.data.lines[line], panel.low, panel.high));
        const kept = curves.map(({ k }) => (this.kept && this.kept[k] !== lines[k] ? this.kept[k] : -1));
        plot.setData([this.times, ...kept.map(values), ...curves.map(({ k }) => values(lines[k]))]);
        const names = curves.map((curve) => curve.label).join(", ");
        this.places[number].setAttribute("aria-label", `${panel.axis} against ${this.data.clock}: ${names}. ${told}.`);
      });
    }

    toggleKept() {
      this.kept = this.kept ? null : this.answer[2];
      this.keep.setAttribute("aria-pressed", String(Boolean(this.kept)));
      this.show();
    }

    reset() {
      this.inputs.forEach((input, k) => (input.value = this.data.start[k]));
      this.kept = null;
      this.keep.setAttribute("aria-pressed", "false");
      this.show();
    }

    fit() {
      this.plots.forEach((plot, number) => {
        const width = this.places[number].clientWidth;
        if (width && width !== plot.width) plot.setSize({ width, height: plot.height });
      });
    }

    redraw() {
      for (const plot of this.plots) plot.redraw(false, true);
    }
  }

  const lessons = [...document.querySelectorAll("section[data-lesson]")]
    .filter((section) => window.loopbookLessons?.[section.dataset.lesson])
    .map((section) => new Lesson(section, window.loopbookLessons[section.dataset.lesson]));
  const redraw = () => lessons.forEach((lesson) => lesson.redraw());
  night.addEventListener("change", redraw);
  new MutationObserver(redraw).observe(document.body, { attributes: true, attributeFilter: ["data-theme"] });
})();
