// The exercises are answered in the page: this asks the Python in judge.js and shows what it says.
//
// A page holds <div class="exercise" data-exercise="7.1"> with fields and buttons. Nothing is judged here. Until a
// button needs it, no Python is loaded: hints and solutions with the numbers of everybody are beside the pages.
//
// What is remembered stays in this browser, under one key of its storage:
//   student    a name, for numbers of one's own
//   answered   {"7.1": true, "7.1 Mira": false}, as the notebooks keep it in .loopbook-progress.json
//   tried      {"7.1": {answers, attempts, hints, response}}, what was typed, how far it went, and what was said of it
"use strict";

(() => {
  const KEY = "loopbook";
  const FILE = "loopbook-progress.json";
  const LARGEST = 1e6; // a larger file is none that was written here
  const SHOWN = "loopbook-shown"; // a cache of statements with somebody's own numbers
  const here = document.currentScript.src;
  const known = window.loopbookExercises;
  const byWeb = location.protocol.startsWith("http") && "Worker" in window && "WebAssembly" in window;

  // ------------------------------------------------------------------------------------------------ what is remembered

  let memory = {};
  let isKept = true; // where a browser keeps nothing, or no more, at least this page does

  function remembered() {
    try {
      if (isKept) memory = table(JSON.parse(localStorage.getItem(KEY)));
    } catch {
      // private windows may have no storage, and somebody else may have written there
    }
    const { student, answered, tried } = memory;
    return { student: isName(student) ? student : null, answered: table(answered), tried: table(tried) };
  }

  // As loopbook.exercises.student takes it: one line, without signs that nobody sees.
  function isName(text) {
    return typeof text === "string" && text.trim() !== "" && text.length <= 100 && !/[\p{C}\p{Zl}\p{Zp}]/u.test(text);
  }

  function table(value) {
    return value && typeof value === "object" && !Array.isArray(value) ? value : {};
  }

  function remember(change) {
    memory = remembered(); // another window may have written since
    change(memory);
    try {
      localStorage.setItem(KEY, JSON.stringify(memory));
      isKept = true;
    } catch {
      isKept = false;
    }
    for (const show of [...exercises, ...summaries]) show.showProgress();
    document.dispatchEvent(new Event("loopbook-progress")); // scorm.js listens
  }

  function keyOf(number, student) {
    return student ? `${number} ${student}` : number;
  }

  // ------------------------------------------------------------------------------------------------ Python, when needed

  let judge = null;
  const waiting = new Set(); // exercises that show how far loading is

  // The judge of this page. Until it is asked it loads nothing; but a Python that is there does not end.
  async function makeJudge() {
    const { Judge } = await import(new URL("judge.js", here));
    const onProgress = (news) => waiting.forEach((exercise) => exercise.showLoading(news));
    judge ??= new Judge({ version: known.version, onProgress });
  }

  async function ask(request) {
    try {
      if (!judge) await makeJudge();
    } catch {
      throw new Error("What checks answers could not be loaded: look whether there is a network, and press again.");
    }
    const reply = await judge.ask(request);
    if (judge.library && judge.library !== known.version) {
      throw new Error("There is a new version of the book: reload this page. What you have typed stays.");
    }
    if (reply.problem) throw new Error(reply.problem);
    return reply;
  }

  function sentence(text) {
    const isFile = /^\S+\.\w/.test(text);
    const whole = isFile ? text : text.slice(0, 1).toUpperCase() + text.slice(1);
    return /[.!?]$/.test(whole) ? whole : `${whole}.`;
  }

  // What is kept of a response: its words. A picture would fill the storage of the browser.
  function wordsOf(response) {
    const parts = made("div", { innerHTML: response.html });
    for (const picture of parts.querySelectorAll("img")) picture.remove();
    return { ...response, html: parts.innerHTML };
  }

  const helps = new Map(); // hints and solutions of a chapter with the numbers of everybody

  function help(number) {
    const chapter = number.split(".")[0].toLowerCase();
    if (!helps.has(chapter)) {
      const file = fetch(new URL(`exercises/help-${chapter}.json`, here)).then((answer) => {
        if (!answer.ok) throw new Error(answer.statusText);
        return answer.json();
      });
      file.catch(() => helps.delete(chapter)); // the next press tries again
      helps.set(chapter, file);
    }
    return helps.get(chapter).then((exercises) => exercises[number]);
  }

  async function shown(number, student) {
    const place = new URL(`exercises/${known.version}/${number}?${encodeURIComponent(student)}`, here);
    const cache = await globalThis.caches?.open(SHOWN).catch(() => null);
    return {
      kept: async () => (await cache?.match(place))?.json(),
      keep: (reply) => cache?.put(place, new Response(JSON.stringify(reply))).catch(() => {}),
    };
  }

  // ---------------------------------------------------------------------------------------------------- small helpers

  function made(tag, properties = {}, ...children) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  }

  const MARKS = { right: "✓", mistake: "≈", wrong: "✗", "not judged": "?", open: "…", "to be marked": "✎" };

  // ------------------------------------------------------------------------------------------------------- an exercise

  class Exercise {
    constructor(element) {
      this.element = element;
      this.number = element.dataset.exercise;
      this.rungs = Number(element.dataset.rungs);
      this.form = element.querySelector("form");
      for (const part of ["statement", "fields", "answer", "hints", "solved", "loading", "known", "whose"]) {
        this[part] = element.querySelector(`.${part}`);
      }
      for (const name of ["check", "hint", "solve", "own"]) this[`${name}Button`] = element.querySelector(`button.${name}`);
      this.everybodys = { html: this.statement.innerHTML, controls: this.fields.innerHTML };
      this.student = null; // whose numbers are shown
      this.isBusy = false;
      this.form.addEventListener("submit", (event) => {
        event.preventDefault();
        this.act(() => this.check());
      });
      this.hintButton?.addEventListener("click", () => this.act(() => this.hint()));
      this.solveButton.addEventListener("click", () => this.act(() => this.solve()));
      this.ownButton?.addEventListener("click", () => (this.isStrange ? renewAll(this) : askForName(this)));
      this.form.addEventListener("input", (event) => this.typed(event.target));
      this.form.addEventListener("click", (event) => this.putIn(event.target));
      this.form.addEventListener("mousedown", (event) => {
        if (event.target.closest(".key")) event.preventDefault(); // the field keeps the focus, and its keyboard
      });
      this.form.addEventListener("keydown", (event) => {
        const isWhole = event.key === "Enter" && (event.ctrlKey || event.metaKey);
        if (isWhole && event.target.tagName === "TEXTAREA") this.form.requestSubmit(this.checkButton);
      });
    }

    get key() {
      return keyOf(this.number, this.student);
    }

    get tried() {
      return table(remembered().tried[this.key]);
    }

    // Whether the numbers are others than those of the name that is kept.
    get isStrange() {
      return Boolean(this.ownButton) && this.student !== remembered().student;
    }

    get seenHints() {
      return Math.min(Number.isInteger(this.tried.hints) ? this.tried.hints : 0, this.rungs);
    }

    try(change) {
      remember((all) => (all.tried[this.key] = { ...table(all.tried[this.key]), ...change }));
    }

    // One thing at a time, and whatever fails is said in one sentence.
    async act(what) {
      if (this.isBusy) return;
      this.isBusy = true;
      this.element.setAttribute("aria-busy", "true");
      waiting.add(this);
      try {
        await what();
      } catch (problem) {
        this.say("problem", sentence(problem.message));
      }
      waiting.delete(this);
      this.loading.hidden = true;
      this.element.removeAttribute("aria-busy");
      this.isBusy = false;
    }

    showLoading({ share, says }) {
      if (!this.bar) {
        this.bar = made("progress", { max: 1, ariaLabel: "Loading Python" });
        this.words = made("span");
        const once = isSecureContext
          ? "What is loaded stays in this browser: the next visit needs no network."
          : "This address has no https: a browser keeps nothing of it, and loads this again at each visit.";
        this.loading.replaceChildren(this.bar, this.words, made("p", { role: "status" }, once));
      }
      this.bar.value = share;
      this.words.textContent = says;
      this.loading.hidden = share >= 1;
    }

    say(look, text, ...more) {
      this.answer.className = `answer ${look}`;
      this.answer.replaceChildren(made("p", {}, ...(look === "quiet" ? [text] : [made("strong", {}, text)])), ...more);
    }

    // ----------------------------------------------------------------------------------------------------- the fields

    *places() {
      for (const field of this.fields.querySelectorAll(".field")) yield [field.dataset.name, field];
    }

    answers() {
      const found = {};
      for (const [name, field] of this.places()) {
        const inputs = [...field.querySelectorAll("input, textarea, select")];
        const parts = inputs.filter((input) => input.dataset.part);
        const boxes = inputs.filter((input) => input.type === "checkbox");
        if (parts.length) {
          found[name] = Object.fromEntries(parts.map((input) => [input.dataset.part, input.value]));
        } else if (boxes.length) {
          found[name] = boxes.filter((box) => box.checked).map((box) => box.value);
        } else if (inputs[0]?.type === "radio") {
          found[name] = inputs.find((button) => button.checked)?.value ?? "";
        } else if (inputs.length) {
          found[name] = inputs[0].value;
        }
      }
      return found;
    }

    fillIn(answers) {
      for (const [name, field] of this.places()) {
        const answer = answers[name];
        if (answer === undefined) continue;
        for (const input of field.querySelectorAll("input, textarea, select")) {
          if (input.dataset.part) input.value = answer?.[input.dataset.part] ?? input.value;
          else if (input.type === "checkbox") input.checked = [answer].flat().includes(input.value);
          else if (input.type === "radio") input.checked = input.value === answer;
          else input.value = answer;
        }
      }
    }

    typed(input) {
      if (input.type === "checkbox" && input.checked) {
        // none of them, or some of them
        for (const other of input.closest(".choices").querySelectorAll("input")) {
          if ("none" in input.dataset ? other !== input : "none" in other.dataset) other.checked = false;
        }
      }
      const field = input.closest(".field");
      field.querySelector(".verdict").replaceChildren();
      field.removeAttribute("data-status");
      for (const one of field.querySelectorAll("[aria-invalid]")) one.removeAttribute("aria-invalid");
      clearTimeout(this.later);
      this.later = setTimeout(() => this.try({ answers: this.answers(), response: null }), 200);
      this.typeset(input);
    }

    // A formula in two dimensions, as Python reads it where Python is there: it is not loaded for that, and asked one
    // thing at a time. What is not whole is grey; where it cannot be read (yet), that is what could be read last.
    async typeset(input) {
      const { value: text, dataset: { symbols } } = input;
      if (!symbols || !judge?.library || input.isAsked) return;
      input.isAsked = true;
      const { mathml } = await ask({ do: "typeset", text, symbols }).catch(() => ({}));
      input.isAsked = false;
      if (input.value !== text) this.typeset(input); // more was typed meanwhile
      const place = input.closest(".field").querySelector(".typeset");
      place.classList.toggle("stale", !mathml || text.split("(").length > text.split(")").length);
      if (mathml || !text.trim()) place.innerHTML = mathml ?? "";
    }

    // A key writes at the cursor, around what is selected, and leaves the cursor where one types on; or it moves on.
    write({ dataset: { writes } }, input) {
      const { selectionStart: from, selectionEnd: to, value } = input;
      const [before, after] = writes.split("|");
      const space = /^\w/.test(before) && /\w$/.test(value.slice(0, from)) ? " " : ""; // T and s are not Ts
      const chosen = after === undefined ? "" : value.slice(from, to);
      const next = value.indexOf("()", from) + 1 || value.indexOf(")", from) + 1 || value.length;
      if (writes) input.setRangeText(space + before + chosen + (after ?? ""), from, to);
      input.selectionStart = input.selectionEnd = writes ? from + (space + before + chosen).length : next;
      this.typed(input);
    }

    // A word in a list that has an order: its button writes it behind what is there.
    putIn(target) {
      const button = target.closest(".word, .key");
      if (!button) return;
      const input = button.closest(".field").querySelector("input");
      if (button.matches(".key")) return this.write(button, input);
      input.value = [input.value.trim().replace(/,$/, ""), button.textContent].filter(Boolean).join(", ");
      this.typed(input);
    }

    // ---------------------------------------------------------------------------------------------------- the buttons

    async check() {
      clearTimeout(this.later);
      if (await this.renewed()) {
        others(this);
        return this.say("quiet", `These are the numbers of ${this.student}. Answer these.`);
      }
      const answers = this.answers();
      if (!Object.values(answers).some(isFilledIn)) {
        this.say("quiet", "Nothing is filled in yet.");
        this.fields.querySelector("input, textarea, select")?.focus();
        return;
      }
      this.try({ answers });
      this.say("quiet", "Checking …");
      const reply = await ask({ do: "check", exercise: this.number, student: this.student, answers });
      remember((all) => {
        all.answered[this.key] = reply.right || all.answered[this.key] === true; // what was right once stays so
        const tried = table(all.tried[this.key]);
        const response = { ...reply, version: known.version };
        all.tried[this.key] = { ...tried, answers, attempts: (tried.attempts ?? 0) + 1, response: wordsOf(response) };
      });
      this.showVerdicts(reply);
      for (const input of this.fields.querySelectorAll("[data-symbols]")) this.typeset(input);
    }

    showVerdicts(reply) {
      const spoken = [];
      const places = new Map(this.places());
      for (const { name, status, html } of reply.verdicts) {
        const field = places.get(name);
        if (!field) continue;
        field.dataset.status = status;
        const mark = made("span", { className: "mark", ariaHidden: "true" }, MARKS[status]);
        field.querySelector(".verdict").replaceChildren(mark, made("span", { innerHTML: html }));
        for (const input of field.querySelectorAll("input[type=text], textarea, select")) {
          if (status === "right" || status === "open") input.removeAttribute("aria-invalid");
          else input.setAttribute("aria-invalid", "true");
        }
        const words = field.querySelector(".verdict").lastChild.textContent; // formulas without their dollars
        if (status !== "right") spoken.push(`${name}: ${words}`);
      }
      const look = reply.right ? "right" : reply.verdicts.some(({ status }) => status === "right") ? "partly" : "wrong";
      // a reader who hears the page hears the verdicts here, one who sees it has them beside the fields
      const heard = made("p", { className: "only-heard" }, spoken.join(". "));
      const more = made("div", { innerHTML: reply.html });
      this.say(look, `${reply.right ? "✓ " : ""}${sentence(reply.says)}`, heard, more);
    }

    // Of an earlier visit: it is there to be read, and not said aloud before anybody has pressed a button.
    showAgain(response) {
      this.answer.setAttribute("aria-live", "off");
      this.showVerdicts(response);
      setTimeout(() => this.answer.setAttribute("aria-live", "polite"), 1000);
    }

    async hint() {
      if (await this.renewed()) this.say("quiet", `These are the numbers of ${this.student}.`);
      const shown = this.hints.children.length;
      const before = this.seenHints;
      // those of an earlier visit come together
      const last = Math.min(shown || !before ? shown + 1 : before, this.rungs);
      for (let rung = shown + 1; rung <= last; rung++) {
        const reply = await this.helped({ do: "hint", rung }, ({ hints }) => ({ html: hints[rung - 1] }));
        this.showHint(rung, reply.html);
      }
      this.try({ hints: Math.max(before, last) });
    }

    showHint(rung, html) {
      const head = made("strong", {}, `Hint ${rung} of ${this.rungs}`);
      this.hints.append(made("div", { className: "one-hint" }, head, made("div", { innerHTML: html })));
      const isLast = rung === this.rungs;
      this.hintButton.textContent = isLast ? "No more hints" : "Next hint";
      this.hintButton.setAttribute("aria-disabled", String(isLast));
    }

    async solve(anyway = false) {
      if (this.solved.firstChild) {
        const isOpen = this.solved.hidden;
        this.solved.hidden = !isOpen;
        this.solveButton.setAttribute("aria-expanded", String(isOpen));
        return;
      }
      if (await this.renewed()) this.say("quiet", `These are the numbers of ${this.student}.`);
      if (!anyway && !this.tried.attempts && remembered().answered[this.key] === undefined) {
        const show = made("button", { type: "button" }, "Show it anyway");
        show.addEventListener("click", () => this.act(() => this.solve(true)));
        const why = "The solution comes after your first attempt: a wrong answer is a good beginning, and a hint helps.";
        this.say("quiet", why, show);
        return;
      }
      const reply = await this.helped({ do: "solution" }, ({ solution }) => ({ html: solution }));
      this.showSolution(reply.html);
      if (anyway) this.answer.replaceChildren();
      this.solved.firstChild.focus();
    }

    showSolution(html) {
      const head = made("h4", { tabIndex: -1 }, "Solution");
      this.solved.replaceChildren(head, made("div", { innerHTML: html }));
      this.solved.hidden = false;
      this.solveButton.setAttribute("aria-expanded", "true");
    }

    // What helps is a file for the numbers of everybody, as long as no Python is there; else Python says it.
    async helped(request, fromFile) {
      if (!this.student && !judge?.library) {
        try {
          return fromFile(await help(this.number));
        } catch {
          // then Python
        }
      }
      return ask({ ...request, exercise: this.number, student: this.student });
    }

    // ------------------------------------------------------------------------------------------------- whose numbers

    // Show the numbers of the name that is kept; true where they were others before.
    async renewed() {
      if (!this.isStrange) return false;
      const { student } = remembered();
      if (!student) {
        this.become(null, this.everybodys);
        return true;
      }
      const { kept, keep } = await shown(this.number, student);
      let reply = await kept();
      if (!reply) {
        reply = await ask({ do: "show", exercise: this.number, student });
        keep(reply);
      }
      this.become(student, reply);
      return true;
    }

    become(student, { html, controls }) {
      this.student = student;
      this.statement.innerHTML = html;
      this.fields.innerHTML = controls;
      this.answer.replaceChildren();
      this.hints.replaceChildren();
      this.solved.replaceChildren();
      this.begin();
    }

    // What was typed and how far it went, after a reload and with other numbers.
    begin() {
      this.fillIn(table(this.tried.answers));
      const { response } = this.tried;
      const hints = this.seenHints;
      if (response?.version === known.version && Array.isArray(response.verdicts)) this.showAgain(response);
      if (this.hintButton) {
        this.hintButton.textContent = hints > 1 ? `The ${hints} hints again` : hints ? "The hint again" : "Hint";
        this.hintButton.removeAttribute("aria-disabled");
      }
      this.solveButton.setAttribute("aria-expanded", "false");
      this.showProgress();
    }

    // After a reload the statement has the numbers of everybody: hers come from the cache, or when she asks for them.
    async comeBack() {
      const { student } = remembered();
      if (!this.isStrange) return this.begin();
      this.form.inert = true; // what is typed under everybody's numbers would go with them
      const reply = await shown(this.number, student).then(({ kept }) => kept()).catch(() => null);
      this.form.inert = false;
      if (reply) this.become(student, reply);
      else this.begin();
    }

    showProgress() {
      const { answered, student } = remembered();
      const right = answered[this.key];
      this.known.textContent = right === true ? "✓ right" : right === false ? "tried" : "";
      this.known.className = right === true ? "known right" : "known";
      this.element.classList.toggle("of-somebody-else", this.isStrange);
      if (!this.ownButton) return;
      const [whose, change] = !student ? ["", this.isStrange ? "Everybody's numbers" : "Your own numbers"]
        : this.isStrange ? ["everybody's numbers", `Show the numbers of ${student}`] : [`numbers of ${student}`, "Change"];
      this.whose.textContent = whose;
      this.ownButton.textContent = change;
    }
  }

  function isFilledIn(answer) {
    if (typeof answer === "string") return answer.trim() !== "";
    if (Array.isArray(answer)) return answer.length > 0;
    return Object.entries(answer).some(([part, text]) => part !== "form" && text.trim() !== "");
  }

  // ------------------------------------------------------------------------------------------------------ a name, once

  let dialog = null;

  function askForName(exercise) {
    dialog ??= nameDialog();
    const { student } = remembered();
    dialog.input.value = student ?? "";
    dialog.forget.hidden = !student;
    dialog.problem.textContent = "";
    dialog.asking = exercise;
    dialog.element.showModal();
    dialog.input.select();
  }

  function nameDialog() {
    const input = made("input", { type: "text", id: "exercise-name", autocomplete: "off", maxLength: 100 });
    const label = made("label", { htmlFor: "exercise-name" }, "Your name");
    const problem = made("p", { className: "problem", role: "alert" });
    const use = made("button", { type: "submit", className: "check" }, "Use my numbers");
    const forget = made("button", { type: "button" }, "Back to everybody's numbers");
    const cancel = made("button", { type: "button" }, "Cancel");
    const why = made("p", {}, "Say a name, once for the whole book, and its exercises have your own numbers: the same "
      + "every time, here and in JupyterLab. The name stays in this browser.");
    const form = made("form", { method: "dialog" }, made("h3", {}, "Your own numbers"), why, label, input, problem,
      made("div", { className: "buttons" }, use, forget, cancel));
    const element = made("dialog", { className: "exercise-dialog", ariaLabel: "Your own numbers" }, form);
    const parts = { element, input, problem, forget, asking: null };
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const name = input.value.trim().normalize("NFC");
      if (!name) {
        problem.textContent = "Nothing is there yet: type a name, as Mira.";
        return;
      }
      if (!isName(name)) {
        problem.textContent = "This holds a sign that nobody sees: type the name, in one line.";
        return;
      }
      element.close();
      useName(name, parts.asking);
    });
    forget.addEventListener("click", () => {
      element.close();
      useName(null, parts.asking);
    });
    cancel.addEventListener("click", () => element.close());
    document.body.append(element);
    return parts;
  }

  function useName(student, first) {
    remember((all) => (all.student = student));
    return renewAll(first);
  }

  // The exercise in which a button was pressed comes first, and the others of the page after it.
  async function renewAll(first) {
    const { student } = remembered();
    const whose = student ? `These are the numbers of ${student}.` : "These are the numbers that everybody has.";
    await first.act(async () => {
      if (await first.renewed()) first.say("quiet", whose);
    });
    others(first);
  }

  async function others(first) {
    for (const exercise of exercises.filter((one) => one !== first)) {
      await exercise.act(async () => {
        const typed = Object.values(exercise.answers()).some(isFilledIn);
        if ((await exercise.renewed()) && typed) exercise.say("quiet", "The numbers are others now, and so are the answers.");
      });
    }
  }

  // -------------------------------------------------------------------------------------------------------- progress

  function rights(list) {
    const { answered, student } = remembered();
    return list.filter(({ number }) => answered[keyOf(number, student)] === true || answered[number] === true).length;
  }

  class OfChapter {
    constructor(element) {
      this.element = element;
      this.exercises = known.chapters.find(({ chapter }) => chapter === element.dataset.chapter).exercises;
    }

    showProgress() {
      this.element.textContent = `So far ${rights(this.exercises)} of ${this.exercises.length} exercises of this `
        + "chapter are right, which this browser remembers.";
    }
  }

  class OfAll {
    constructor(element) {
      this.element = element;
      this.note = element.querySelector(".progress-note");
      this.to = new URL("..", here);
      element.querySelector(".save").addEventListener("click", () => this.save());
      element.querySelector(".load input").addEventListener("change", (event) => this.load(event.target));
      element.querySelector(".forget").addEventListener("click", () => this.forget());
    }

    showProgress() {
      const { answered, student } = remembered();
      let sum = 0;
      let count = 0;
      for (const { chapter, exercises: list } of known.chapters) {
        const right = rights(list);
        const row = this.element.querySelector(`li[data-chapter="${chapter}"]`);
        row.querySelector(".count").textContent = `${right} of ${list.length}`;
        row.querySelector(".bar span").style.width = `${(100 * right) / list.length}%`;
        row.classList.toggle("begun", right > 0);
        sum += right;
        count += list.length;
      }
      if (!Object.keys(answered).length) return;
      const says = `${sum} of ${count} exercises are right${student ? `, ${student}` : ""}.`;
      this.element.querySelector(".sum").textContent = says;
      const all = known.chapters.flatMap(({ exercises: list }) => list);
      const last = all.findLastIndex(({ number }) => keyOf(number, student) in answered || number in answered);
      const next = all.slice(Math.max(last, 0)).find(({ number }) => !rights([{ number }]));
      const place = this.element.querySelector(".next");
      place.replaceChildren();
      if (!next) return;
      const href = new URL(`${next.page}#exercise-${next.number.replace(".", "-").toLowerCase()}`, this.to);
      place.append("Go on with ", made("a", { href }, `Exercise ${next.number} · ${next.title}`));
    }

    save() {
      const { answered, student, tried } = remembered();
      const sorted = Object.fromEntries(Object.entries(answered).sort(([one], [other]) => (one < other ? -1 : 1)));
      const all = { answered: sorted, student, tried };
      const file = new Blob([`${JSON.stringify(all, null, 1)}\n`], { type: "application/json" });
      const link = made("a", { href: URL.createObjectURL(file), download: FILE });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
      this.note.textContent = `Saved as ${FILE}. Beside your notebooks, under the name .${FILE}, it is their progress, too.`;
    }

    async load(input) {
      const [file] = input.files;
      input.value = ""; // so that the same file can be read again
      if (!file) return;
      try {
        const text = file.size <= LARGEST ? await file.text() : "null";
        const { answered, student, tried } = JSON.parse(text.replace(/^\ufeff/, ""));
        const isTable = answered && typeof answered === "object" && !Array.isArray(answered);
        if (!isTable || !Object.values(answered).every((right) => typeof right === "boolean")) throw new TypeError();
        remember((all) => {
          for (const [key, right] of Object.entries(answered)) all.answered[key] = right || all.answered[key] === true;
          if (isName(student)) all.student ??= student;
          // what was typed here comes before what was typed elsewhere
          all.tried = { ...typedIn(tried), ...all.tried };
        });
        const count = Object.values(answered).filter(Boolean).length;
        this.note.textContent = `Read from ${file.name}: ${count} right. What was right here before stays so.`;
      } catch {
        this.note.textContent = `${file.name} holds no progress: expected .${FILE} of a notebook, or a file saved here.`;
      }
    }

    forget() {
      if (!confirm("Forget which exercises are right, what you typed, and your name, in this browser?")) return;
      remember((all) => Object.assign(all, { student: null, answered: {}, tried: {} }));
      globalThis.caches?.delete(SHOWN).catch(() => {});
      location.reload();
    }
  }

  // Of what was typed, as a file has it: the answers and how far they went. What was said of them is this book's to say.
  function typedIn(tried) {
    const found = {};
    for (const [key, one] of Object.entries(table(tried))) {
      const { answers, attempts, hints } = table(one);
      found[key] = { answers: table(answers), attempts: Number(attempts) || 0, hints: Number(hints) || 0 };
    }
    return found;
  }

  const exercises = [];
  const summaries = [];

  document.documentElement.classList.add(byWeb ? "answers" : "from-file");
  if (byWeb) {
    for (const element of document.querySelectorAll(".exercise[data-exercise]")) exercises.push(new Exercise(element));
    for (const exercise of exercises) exercise.comeBack();
    if (exercises.length && Object.keys(remembered().tried).length) makeJudge().catch(() => {});
  } else {
    // a browser with JavaScript keeps what is for others as a text
    for (const hidden of document.querySelectorAll(".exercise noscript")) {
      hidden.replaceWith(made("div", { innerHTML: hidden.textContent }));
    }
  }
  for (const element of document.querySelectorAll(".progress-of-chapter")) summaries.push(new OfChapter(element));
  for (const element of document.querySelectorAll(".progress-of-all")) summaries.push(new OfAll(element));
  for (const summary of summaries) summary.showProgress();
  // A telephone's keyboard covers the page and moves nothing in it: the row of keys is lifted above it.
  const { visualViewport: view } = window;
  view?.addEventListener("resize", () => {
    const covered = document.documentElement.clientHeight - view.height - view.offsetTop;
    document.documentElement.style.setProperty("--keyboard", `${Math.max(0, covered)}px`);
  });
  window.addEventListener("storage", ({ key }) => {
    if (key === KEY) for (const show of [...exercises, ...summaries]) show.showProgress();
  });
})();
