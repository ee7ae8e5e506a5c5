// Formulas are written as GitHub shows them too: a block of the language `math`, or code between two dollars.
"use strict";
for (const code of document.querySelectorAll("code.language-math")) {
  const formula = document.createElement("div");
  katex.render(code.textContent, formula, { displayMode: true, throwOnError: false });
  (code.closest("pre") ?? code).replaceWith(formula);
}
for (const code of document.querySelectorAll("main code")) {
  const [before, after] = [code.previousSibling, code.nextSibling];
  if (!before?.textContent.endsWith("$") || !after?.textContent.startsWith("$")) continue;
  before.textContent = before.textContent.slice(0, -1);
  after.textContent = after.textContent.slice(1);
  const formula = document.createElement("span");
  katex.render(code.textContent, formula, { throwOnError: false });
  code.replaceWith(formula);
}
