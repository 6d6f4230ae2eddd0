// The live lessons: sliders choose among pictures that the library has computed, and an SVG picture shows them.
//
// A page holds <section class="lesson" data-lesson="pi"> with its inputs and its pictures as they are at the start. When
// the reader comes near, it loads lessons/pi.js, which sets window.loopbookLessons.pi:
//   counts, start    how many positions each slider has, and which is the first
//   verdict, result, axis, word, image    which of the verdicts, results ... is seen: a number for each position of all
//                    the sliders, the last one moving first, or one number where it is always the same
//   items            lines, areas and points of the pictures; line is which of the lines it is, likewise, or -1 for none
//   lines            their shapes, see path
"use strict";

(() => {
  const WIDE = 1000; // steps of a picture, as in docs/lessons/shapes.py
  const TALL = 800;
  const ALPHABET = Array.from({ length: 92 }, (_, k) => String.fromCharCode(35 + k)).filter((letter) => letter !== "\\");
  const DIGIT = Object.fromEntries(ALPHABET.map((letter, value) => [letter, value]));
  const BASE = ALPHABET.length;
  const NEAR = 40;
  const FAR = 2 * NEAR + 1;
  const FARTHEST = FAR + 8;
  const LIFT = FARTHEST + 1;
  const NEARBY = "800px"; // from the window, where a lesson begins to load

  // The path of a shape: each corner is the way from the one before it, in letters.
  function path(text, closed) {
    const end = closed ? "Z" : "";
    let written = "";
    let x = 0;
    let y = 0;
    let corners = 0;
    let upright = false; // whether the next number is a way down or up
    for (let k = 0; k < text.length; k++) {
      let value = DIGIT[text[k]];
      if (value === LIFT) {
        written += (corners === 1 ? `L${x} ${y}` : "") + end;
        corners = 0;
        continue;
      }
      if (value < FAR) value -= NEAR;
      else if (value < FARTHEST) value = (value - FAR - 4) * BASE + DIGIT[text[++k]];
      else value = DIGIT[text[++k]] * BASE + DIGIT[text[++k]] - Math.floor(BASE ** 2 / 2);
      if (!upright) x += value;
      else {
        y += value;
        written += `${corners ? "L" : "M"}${x} ${y}`;
        corners += 1;
      }
      upright = !upright;
    }
    return written + (corners === 1 ? `L${x} ${y}` : "") + (text ? end : "");
  }

  function element(name, className, html) {
    const made = document.createElement(name);
    if (className) made.className = className;
    made.innerHTML = html;
    return made;
  }

  class Lesson {
    constructor(section, data) {
      this.section = section;
      this.data = data;
      this.inputs = [...section.querySelectorAll(".lesson-slider input, .lesson-slider select")];
      this.plots = [...section.querySelectorAll(".lesson-plot")];
      this.frames = [...section.querySelectorAll(".lesson-frame")];
      this.image = section.querySelector(".lesson-image img");
      this.result = section.querySelector(".lesson-result");
      this.keep = section.querySelector(".lesson-keep"); // not where there are no curves
      const each = (sign) => data.items.map((item, k) => section.querySelector(sign.replace("#", k)));
      this.paths = each('path[data-item="#"]');
      this.legends = each('li[data-item="#"]');
      this.grey = each('path[data-kept="#"]');
      this.kept = null; // the position whose lines stay for comparison
      for (const input of this.inputs) input.addEventListener("input", () => this.show());
      section.querySelector(".lesson-reset").addEventListener("click", () => this.reset());
      this.keep?.addEventListener("click", () => this.toggleKept());
      section.classList.add("lesson-live");
      this.show();
    }

    // The number of the position of all the sliders.
    get position() {
      return this.inputs.reduce((sum, input, k) => sum * this.data.counts[k] + Number(input.value), 0);
    }

    // What a column has at the present position, or at another one.
    at(column, position = this.shown) {
      return Array.isArray(column) ? column[position] : column;
    }

    // Draw what is not as it was at the last position of the sliders, at first all of it.
    show() {
      const { data, shown: before } = this;
      this.shown = this.position;
      const isNew = (column) => before === undefined || this.at(column) !== this.at(column, before);
      data.items.forEach((item, k) => {
        if (!isNew(item.line)) return;
        const line = this.at(item.line);
        this.paths[k].setAttribute("d", line < 0 ? "" : path(data.lines[line], item.kind === "area"));
        if (this.legends[k]) this.legends[k].hidden = line < 0;
      });
      if (isNew(data.axis)) this.drawAxes(data.axes[this.at(data.axis)]);
      if (isNew(data.word)) this.write(data.groups[this.at(data.word)]);
      if (this.image && isNew(data.image)) {
        this.image.hidden = this.at(data.image) < 0;
        this.image.src = `data:image/png;base64,${data.images[this.at(data.image)] ?? ""}`;
      }
      this.drawKept();
      this.tell(data.verdicts[this.at(data.verdict)], data.results[this.at(data.result)]);
    }

    drawAxes(axes) {
      axes.forEach(([across, up], n) => {
        const frame = this.frames[n];
        const grid = frame.querySelector(".lesson-grid");
        const upright = across.map(([share]) => `M${Math.round(share * WIDE)} 0V${TALL}`);
        grid?.setAttribute("d", upright.concat(up.map(([share]) => `M0 ${Math.round((1 - share) * TALL)}H${WIDE}`)).join(""));
        const numbers = (name, pairs, side) =>
          frame.querySelector(name)?.replaceChildren(
            ...pairs.map(([share, text]) => {
              const label = element("span", "", text);
              label.style[side] = `${100 * share}%`;
              return label;
            }),
          );
        numbers(".lesson-y", up, "bottom");
        numbers(".lesson-x", across, "left");
        frame.classList.toggle("lesson-many", across.length > 6);
      });
    }

    write(words) {
      for (const old of this.section.querySelectorAll(".lesson-word")) old.remove();
      for (const word of words) {
        const [panel, left, top, right, down, side, level, text] = this.data.words[word];
        const label = element("span", "lesson-word", text);
        label.style.left = `${left}%`;
        label.style.top = `${top}%`;
        label.style.transform = `translate(calc(${side}% + ${right}px), calc(${level}% + ${down}px))`;
        this.frames[panel].append(label);
      }
    }

    // The verdict and the results, to be seen and to be heard.
    tell(verdict, results) {
      const pairs = this.data.labels.map((label, k) => element("span", "", `${label} <b>${results[k]}</b>`));
      const first = verdict ? [element("strong", "", verdict)] : [];
      this.result.replaceChildren(...first.concat(pairs).flatMap((part) => [part, " "]));
      for (const input of this.inputs.filter((one) => one.dataset.texts)) {
        const text = JSON.parse(input.dataset.texts)[input.value];
        input.setAttribute("aria-valuetext", text);
        input.parentElement.querySelector("output").textContent = text;
      }
      const told = this.result.textContent.trim();
      this.plots.forEach((plot) => {
        plot.dataset.names ??= plot.getAttribute("aria-label").split(". ")[0];
        plot.setAttribute("aria-label", `${plot.dataset.names}. ${told}`);
      });
      if (this.image) this.image.alt = told;
    }

    drawKept() {
      const { data, kept } = this;
      const comparable = kept !== null && this.at(data.axis, kept) === this.at(data.axis); // other axes would mislead
      data.items.forEach((item, k) => {
        const line = comparable ? this.at(item.line, kept) : -1;
        const seen = line >= 0 && line !== this.at(item.line);
        this.grey[k]?.setAttribute("d", seen ? path(data.lines[line], false) : "");
      });
    }

    toggleKept() {
      this.kept = this.kept === null ? this.shown : null;
      this.keep.setAttribute("aria-pressed", String(this.kept !== null));
      this.drawKept();
    }

    reset() {
      this.inputs.forEach((input, k) => (input.value = this.data.start[k]));
      this.kept = null;
      this.keep?.setAttribute("aria-pressed", "false");
      this.show();
    }
  }

  // A script, because a page from a disk may fetch nothing else.
  const here = document.currentScript.src;

  function load(section) {
    const name = section.dataset.lesson;
    const script = document.createElement("script");
    script.src = new URL(`lessons/${name}.js?v=${section.dataset.version}`, here).href;
    script.onload = () => new Lesson(section, window.loopbookLessons[name]);
    document.head.append(script);
  }

  const watch = new IntersectionObserver(
    (seen) => {
      for (const { isIntersecting, target } of seen) {
        if (!isIntersecting) continue;
        watch.unobserve(target);
        load(target);
      }
    },
    { rootMargin: NEARBY },
  );
  for (const section of document.querySelectorAll("section[data-lesson]")) watch.observe(section);
})();
