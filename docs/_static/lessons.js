// The live lessons: sliders choose among pictures that the library has computed, and an SVG picture shows them.
//
// A page holds <section class="lesson" data-lesson="pi"> with its inputs and its pictures as they are at the start. When
// the reader comes near, it loads lessons/pi.js, which sets window.loopbookLessons.pi:
//   counts, start    how many positions each slider has, and which is the first
//   verdict, result, axis, word, image    which of the verdicts, results ... is seen: a number for each position of all
//                    the sliders, the last one moving first, or one number where it is always the same
//   items            lines, areas and points of the pictures; line is which of the lines it is, likewise, -1 for none,
//                    or -2 for one between those of the nearest positions of the slider `along` that have one
//   lines            their shapes, see corners
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

  const BETWEEN = -2;
  const UPRIGHT = 0.001; // of a way up or down, as in docs/lessons/shapes.py

  // The corners of a shape, piece by piece: each corner is the way from the one before it, in letters.
  function corners(text) {
    const pieces = text ? [[]] : [];
    const place = [0, 0];
    let upright = 0; // whether the next number is a way down or up
    for (let k = 0; k < text.length; k++) {
      let value = DIGIT[text[k]];
      if (value === LIFT) {
        pieces.push([]);
        continue;
      }
      if (value < FAR) value -= NEAR;
      else if (value < FARTHEST) value = (value - FAR - 4) * BASE + DIGIT[text[++k]];
      else value = DIGIT[text[++k]] * BASE + DIGIT[text[++k]] - Math.floor(BASE ** 2 / 2);
      place[upright] += value;
      if (upright) pieces.at(-1).push([...place]);
      upright = 1 - upright;
    }
    return pieces;
  }

  // A piece as a function of how far one is along it, from 0 to 1, and where its corners are.
  function walk(piece) {
    const far = [0];
    for (let k = 1; k < piece.length; k++) {
      const [right, down] = [0, 1].map((n) => Math.abs(piece[k][n] - piece[k - 1][n]));
      far.push(far[k - 1] + right + UPRIGHT * down);
    }
    const whole = far.at(-1) || 1;
    let k = 0; // corners are asked for in their order
    const at = (share) => {
      while (k < far.length - 2 && far[k + 1] < share * whole) k++;
      if (piece.length === 1) return piece[0];
      const part = (share * whole - far[k]) / (far[k + 1] - far[k] || 1);
      return piece[k].map((value, n) => value + part * (piece[k + 1][n] - value));
    };
    return { at, shares: far.map((way) => way / whole) };
  }

  // The shape between two others, as docs/lessons/shapes.py has it.
  function between(one, other, share) {
    return one.map((piece, n) => {
      const [first, last] = [walk(piece), walk(other[n])];
      const shares = [...new Set([...first.shares, ...last.shares])].sort((a, b) => a - b);
      return shares.map((place) => {
        const end = last.at(place);
        return first.at(place).map((value, k) => Math.round(10 * (value + share * (end[k] - value))) / 10);
      });
    });
  }

  // A browser draws a line without length as a dot.
  function path(pieces, closed) {
    const all = pieces.map((piece) => (piece.length === 1 ? [piece[0], piece[0]] : piece));
    return all.map((piece) => `M${piece.map((place) => place.join(" ")).join("L")}${closed ? "Z" : ""}`).join("");
  }

  // The values of an axis, as a function of the share of the frame; none where they are not even.
  function scale(numbers) {
    const [first, ...more] = numbers.map(([share, text]) => [share, Number(text.replace("−", "-"))]);
    const last = more.at(-1);
    if (!last) return null;
    const slope = (last[1] - first[1]) / (last[0] - first[0]);
    const at = (share) => first[1] + slope * (share - first[0]);
    if (!more.every(([share, value]) => Math.abs(value - at(share)) < 0.01 * Math.abs(slope))) return null;
    const digits = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(slope))));
    return { at, says: (value) => value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1").replace("-", "−") };
  }

  const SETTLED = 0.05; // of a change: a curve that stays so close to its end has settled

  const [FEW, MANY] = [3, 30]; // turns of a curve that oscillates; what has more is noise

  // The points of a curve from one time to another, with those at its ends.
  function during(points, from, until) {
    const at = (time) => {
      const n = points.findIndex(([x]) => x >= time);
      if (n < 1) return n ? [] : [points[0]];
      const [before, after] = [points[n - 1], points[n]];
      return [[time, before[1] + ((time - before[0]) / (after[0] - before[0])) * (after[1] - before[1])]];
    };
    return [...at(from), ...points.filter(([x]) => x > from && x < until), ...at(until)];
  }

  // The values at which a curve turns.
  const turnsOf = (values) => values.filter((y, n) => (y - values[n - 1]) * (values[n + 1] - y) < 0);

  // What a curve does from a time on, in words; points are (time, value), and goal is the setpoint, where there is one.
  function told(points, goal, time, value, [unitOfTime, unit]) {
    const values = points.map(([, y]) => y);
    const [first, last, low, high] = [values[0], values.at(-1), Math.min(...values), Math.max(...values)];
    if (low < value.at(0) || high > value.at(1)) return "leaves the picture"; // and how far, nobody knows here
    const [from, until] = [points[0][0], points.at(-1)[0]];
    // where it rests: at its end, or in the middle of its last waves, if it hardly moves any more, or else at the setpoint
    const late = during(points, until - (until - from) / 5, until).map(([, y]) => y);
    const [bottom, top] = [Math.min(...late), Math.max(...late)];
    const isWave = turnsOf(late).length > 0;
    const isAtRest = top - bottom < (isWave ? 2 * SETTLED : SETTLED / 2) * (high - low);
    const isAround = bottom < goal && goal < top;
    const rest = isAtRest && !isAround ? (isWave ? (bottom + top) / 2 : last) : (goal ?? last);
    const [way, rises] = [Math.abs(rest - first), rest > first];
    const isLoad = goal !== undefined && Math.abs(first - goal) < 2 * SETTLED * (high - low);
    const isStep = way > 0.5 * (high - low) && !isLoad;
    const band = SETTLED * (isStep ? way : high - low);
    const k = values.findLastIndex((y) => Math.abs(y - rest) > band);
    const isSettled = k < values.length - 1 && (isAtRest || goal !== undefined);
    const turns = turnsOf(values).filter((y) => Math.abs(y - rest) > band).length;
    const says = [];
    const aim = isLoad ? goal : rest;
    const isHigh = high - aim > aim - low;
    if (!isSettled && turns > FEW) {
      says.push(`${turns > MANY ? "varies" : "oscillates"} between ${value.says(low)} and ${value.says(high)}${unit}`);
    } else if (isStep) {
      const wrong = rises ? low : high;
      const begun = values.findIndex((y) => Math.abs(y - first) > way / 2 && y > first === rises);
      if (Math.abs(wrong - first) > band && values.indexOf(wrong) < begun) {
        says.push(`${rises ? "falls" : "rises"} to ${value.says(wrong)}${unit} first`);
      }
      const peak = rises ? high : low;
      const end = isSettled || Math.abs(peak - last) < band ? `to ${value.says(last)}` : `as far as ${value.says(peak)}`;
      says.push(`${rises ? "rises" : "falls"} ${end}${unit}`);
    } else says.push(`${isHigh ? "rises" : "falls"} as far as ${value.says(isHigh ? high : low)}${unit}`);
    const beyond = Math.round((100 * (rises ? high - rest : rest - low)) / way);
    if (isStep && beyond > 0 && (isAtRest || goal !== undefined)) says.push(`overshoots by ${beyond} %`);
    if (!isSettled) return [...says, "has not settled"].join(", ");
    if (k < 0) return says.join(", ");
    const [before, after] = [points[k], points[k + 1]];
    const outside = (Math.abs(before[1] - rest) - band) / Math.abs(after[1] - before[1]);
    const settled = before[0] + outside * (after[0] - before[0]) - from;
    return [...says, `settles to ${100 * SETTLED} % after about ${time.says(settled)}${unitOfTime}`].join(", ");
  }

  const unitOf = (name) => name.match(/\[(.+)\]/)?.[1].replace(/^1$/, "").replace(/^./, "\u202f$&") ?? "";

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
      this.words = section.querySelector(".lesson-words"); // not where there are no curves, too
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

    // The shape of an item at the present position, or at another one.
    shape({ line: column }, position = this.shown) {
      const { counts, along, lines } = this.data;
      const line = this.at(column, position);
      if (line !== BETWEEN) return corners(lines[line] ?? "");
      const step = counts.slice(along + 1).reduce((product, count) => product * count, 1);
      let [before, after] = [position - step, position + step];
      while (column[before] < 0) before -= step;
      while (column[after] < 0) after += step;
      const ends = [before, after].map((place) => corners(lines[column[place]]));
      return between(...ends, (position - before) / (after - before));
    }

    // Draw what is not as it was at the last position of the sliders, at first all of it.
    show() {
      const { data, shown: before } = this;
      this.shown = this.position;
      const isNew = (column) =>
        before === undefined || this.at(column) === BETWEEN || this.at(column) !== this.at(column, before);
      data.items.forEach((item, k) => {
        if (!isNew(item.line)) return;
        const shape = this.shape(item);
        this.paths[k].setAttribute("d", path(shape, item.kind === "area"));
        if (this.legends[k]) this.legends[k].hidden = !shape.length;
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

    // What the curves of a panel do, in words: of the first panel how they go on, of the others how far they go.
    inWords({ axis, clock }, panel) {
      const [time, value] = this.data.axes[this.at(this.data.axis)][panel]?.map(scale) ?? [];
      if (!time || !value || !clock.startsWith("<i>t</i>")) return [];
      const units = [unitOf(clock), unitOf(axis)];
      const [whole, height] = [time, value].map(({ at }) => Math.abs(at(1) - at(0)));
      const span = (points, n) => Math.max(...points.map((one) => one[n])) - Math.min(...points.map((one) => one[n]));
      const lines = this.data.items.filter((item) => item.panel === panel && item.kind === "line");
      const curves = lines
        .map((item) => [item.label, this.shape(item).flat().map(([x, y]) => [time.at(x / WIDE), value.at(1 - y / TALL)])])
        .filter(([, points]) => points.length);
      // from when on: a step of the setpoint, and upright lines with a word
      const setpoint = curves.find(([label]) => label === "setpoint")?.[1] ?? [];
      const step = setpoint.findIndex(([, y], k) => k && Math.abs(y - setpoint[k - 1][1]) > 0.01 * height);
      const times = [[step < 0 ? time.at(0) : setpoint[step][0], ""]];
      for (const word of this.data.groups[this.at(this.data.word)].map((one) => this.data.words[one])) {
        const at = time.at(word[1] / 100);
        const isHere = ([, points]) =>
          span(points, 0) === 0 && span(points, 1) > 0.9 * height && Math.abs(points[0][0] - at) < 0.01 * whole;
        if (word[0] === panel && curves.some(isHere)) times.push([at, word.at(-1)]);
      }
      const moving = curves.filter(
        ([label, points]) => label !== "setpoint" && span(points, 0) > 0.1 * whole && span(points, 1) > 0.005 * height,
      );
      const all = moving.flatMap(([, points]) => points);
      const spoken = panel && moving.length && !moving[0][0] ? [["", all]] : moving.slice(0, moving[0]?.[0] ? 2 : 1);
      return spoken.map(([label, points]) => {
        const name = label || axis.replace(/ *\[.*/, "");
        const [low, high] = [Math.min, Math.max].map((end) => end(...points.map(([, y]) => y)));
        if (panel && (low < value.at(0) || high > value.at(1))) return `${name} leaves the picture.`;
        if (panel) return `${name} is between ${value.says(low)} and ${value.says(high)}${units[1]}.`;
        const says = times.map(([from, word], k) => {
          const part = during(points, from, times[k + 1]?.[0] ?? points.at(-1)[0]);
          const isStill = part.length < 3 || span(part, 1) < 0.005 * height;
          return isStill ? "" : `${word ? `after ${word} it ` : ""}${told(part, setpoint.at(-1)?.[1], time, value, units)}`;
        });
        return `${name} ${says.filter(Boolean).join("; ")}.`;
      });
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
      const clock = this.data.panels.at(-1)?.clock;
      const words = this.data.panels.flatMap((panel, n) => this.inWords({ ...panel, clock }, n));
      if (this.words) this.words.innerHTML = words.join(" ");
      const told = [this.result, this.words].map((part) => part?.textContent.trim()).filter(Boolean).join(". ");
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
        const isElsewhere = kept !== this.shown && Array.isArray(item.line);
        this.grey[k]?.setAttribute("d", comparable && isElsewhere ? path(this.shape(item, kept), false) : "");
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
