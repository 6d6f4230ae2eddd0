// Cuts what belongs to a student into sheets, each with a foot that says whose it is and which of how many.
"use strict";

for (const article of document.querySelectorAll("article")) {
  const sheets = [];
  const begin = () => {
    const sheet = document.createElement("div");
    sheet.className = "sheet";
    sheet.innerHTML = "<div class=body></div><footer><span></span><span>sheet 8 of 8</span></footer>";
    sheet.querySelector("span").innerHTML = article.dataset.foot;
    article.before(sheet);
    sheets.push(sheet);
    return sheet.firstChild;
  };
  const isOver = (body) => body.scrollHeight > body.clientHeight + 1;
  let body = begin();
  for (let part of [...article.children]) {
    body.append(part);
    if (isOver(body) && body.children.length > 1) (body = begin()).append(part);
    while (isOver(body) && part.children.length > 1) { // longer than a sheet: its end goes on to the next one
      const rest = part.cloneNode(false);
      while (isOver(body) && part.children.length > 1) rest.prepend(part.lastElementChild);
      (body = begin()).append(rest);
      part = rest;
    }
    if (isOver(body)) part.style.zoom = body.clientHeight / body.scrollHeight;
  }
  const count = sheets.length;
  if (count % 2 && document.querySelectorAll("article").length > 1) begin(); // printed on both sides, the next is hers alone
  sheets.forEach((sheet, place) => {
    sheet.lastChild.lastChild.textContent = place < count ? `sheet ${place + 1} of ${count}` : "this side is empty";
  });
}
for (const article of document.querySelectorAll("article")) article.remove();
