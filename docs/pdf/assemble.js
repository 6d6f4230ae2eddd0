// Puts the pages of the site into one document: ids get the name of their page, links between the pages become links
// within the document, and what leads to other pages of the site is only its words.
//
//   address   of the site
//   parts     [{title, pages: ["chapters/10_tuning.html", ...]}, ...]; a part without a title is the book itself, whose
//             sections are in the contents too
//   title, about   what is on the first sheet
async ({ address, parts, title, about }) => {
  const SCREEN = "script, noscript, button, form, details.check, p.means, details.hide, .headerlink, .lesson-controls, p.opening, p.switches, p.functions, "
    + "p.exercise-links, .content-icon-container";
  const keyOf = (name) => name.replace(/\.html$/, "").replace(/[^\w]+/g, "-");
  const pages = new Map();
  for (const name of parts.flatMap((part) => part.pages)) {
    const url = new URL(name, address);
    const text = await (await fetch(url)).text();
    pages.set(url.pathname, { key: keyOf(name), url, content: new DOMParser().parseFromString(text, "text/html") });
  }

  const made = (tag, attributes = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), attributes);
    element.append(...children);
    return element;
  };

  const lead = (link, { url, key }) => {
    const to = new URL(link.getAttribute("href"), url);
    const page = pages.get(to.pathname);
    if (page) link.setAttribute("href", `#${page.key}${to.hash ? `--${decodeURIComponent(to.hash.slice(1))}` : ""}`);
    else if (to.origin === url.origin) link.replaceWith(...link.childNodes);
  };

  const chapter = (page) => {
    const { key, url, content } = page;
    const article = content.querySelector("article");
    article.querySelectorAll(SCREEN).forEach((part) => part.remove());
    article.querySelectorAll("details.further > summary").forEach((part) => part.replaceWith(made("p", {}, ...part.childNodes)));
    article.querySelectorAll("details").forEach((part) => part.replaceWith(...part.childNodes));
    article.querySelectorAll("summary").forEach((part) => part.remove());
    article.querySelectorAll("[id]:not(svg, svg *)").forEach((part) => { part.id = `${key}--${part.id}`; });
    // a heading may go to the next sheet, and leave its empty section behind
    article.querySelectorAll("section[id] > :is(h1, h2, h3, h4)").forEach((heading) => {
      [heading.id, heading.parentElement.id] = [heading.parentElement.id, ""];
    });
    article.querySelectorAll("[tabindex]").forEach((part) => part.removeAttribute("tabindex"));
    article.querySelectorAll("a[href]").forEach((link) => lead(link, page));
    article.querySelectorAll("img").forEach((image) => {
      image.src = new URL(image.getAttribute("src"), url);
      image.loading = "eager";
    });
    article.id = key;
    article.className = "chapter";
    article.style.page = `the-${key}`;
    return article;
  };

  const look = [];
  const contents = made("nav", { className: "book-contents" }, made("h1", {}, "Contents"));
  const line = (level, id, words, className) => {
    const link = made("a", { href: `#${id}`, className }, made("span", {}, words), made("span", { className: "number" }, "0"));
    link.dataset.level = level;
    contents.append(link);
  };
  const book = [];
  for (const part of parts) {
    if (part.title) {
      const id = keyOf(part.title);
      const opening = made("section", { className: "part", id }, made("h1", {}, part.title));
      opening.style.page = `the-${keyOf(part.pages[0])}`; // on the sheet of its first page
      book.push(opening);
      line(0, id, part.title, "of-part");
    }
    for (const page of part.pages) {
      const article = chapter(pages.get(new URL(page, address).pathname));
      const name = article.querySelector("h1").textContent;
      look.push(`@page the-${article.id} { @top-left { content: ${JSON.stringify(name)} } }`);
      line(part.title ? 1 : 0, article.id, name, "of-chapter");
      if (!part.title) {
        for (const heading of article.querySelectorAll("h2")) {
          line(1, heading.id, heading.textContent, "of-section");
        }
      }
      book.push(article);
    }
  }
  const front = made("section", { className: "title-page" }, made("h1", {}, title), ...about.map((words) => made("p", {}, words)));
  document.head.append(made("style", { media: "print", textContent: look.join("\n") }));
  document.title = title;
  document.body.dataset.print = "all";
  document.body.replaceChildren(front, contents, ...book);
  const fonts = ["", "italic ", "bold "].map((style) => document.fonts.load(`${style}10pt "STIX Two Text"`));
  await Promise.all([...fonts, document.fonts.load('10pt "STIX Two Math"', "x"), ...[...document.images].map((image) => image.decode())]);
}
