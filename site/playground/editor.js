// The editor of a scenario: mistakes at their lines, completion and meanings of keys, the number under the cursor.

import { autocompletion, completionKeymap, closeBrackets } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { StreamLanguage, defaultHighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, lintKeymap, nextDiagnostic, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { EditorView, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";

import { contextAt, numberAt } from "./toml.js";

// What a mistake underlines: its key, its value, or its line.
function range(document, { line, column, key }) {
  if (!line || line > document.lines) return { from: 0, to: Math.min(1, document.length) };
  const { from, to, text } = document.line(line);
  const start = Math.min(from + (column ?? 1) - 1, to);
  const word = /^[\w.]+|^"[^"]*"|^\S+/.exec(text.slice(start - from))?.[0] ?? "";
  return { from: start, to: Math.max(Math.min(start + word.length, to), Math.min(start + 1, to)), key };
}

export class Editor {
  constructor(parent, { onchange, oncursor, onrun }) {
    this.schema = null;
    const complete = (context) => this.complete(context);
    const hover = hoverTooltip((view, position) => this.hover(view, position));
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        extensions: [
          keymap.of([
            { key: "Mod-Enter", run: () => (onrun(), true) },
            { key: "F8", run: nextDiagnostic },
            ...completionKeymap,
            ...lintKeymap,
            ...historyKeymap,
            ...defaultKeymap,
          ]),
          lineNumbers(),
          history(),
          closeBrackets(),
          highlightActiveLine(),
          lintGutter(),
          StreamLanguage.define(toml),
          syntaxHighlighting(defaultHighlightStyle),
          autocompletion({ override: [complete] }),
          hover,
          EditorView.lineWrapping,
          EditorView.contentAttributes.of({ "aria-label": "scenario" }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) onchange();
            if (update.docChanged || update.selectionSet) oncursor();
          }),
        ],
      }),
    });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  set text(text) {
    this.replace(0, this.view.state.doc.length, text);
  }

  replace(from, to, insert) {
    this.view.dispatch({ changes: { from, to, insert } });
  }

  // Marks the mistakes, each with its suggestion as a button.
  mark(mistakes) {
    const document = this.view.state.doc;
    const diagnostics = mistakes.map((mistake) => {
      const { from, to } = range(document, mistake);
      const { suggestion } = mistake;
      const apply = (view, start, end) => view.dispatch({ changes: { from: start, to: end, insert: suggestion } });
      const actions = suggestion ? [{ name: `write ${suggestion}`, apply }] : [];
      return { from, to, severity: "error", message: mistake.message, actions };
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  show(line) {
    const { from } = this.view.state.doc.line(Math.min(Math.max(line, 1), this.view.state.doc.lines));
    this.view.dispatch({ selection: { anchor: from }, effects: EditorView.scrollIntoView(from, { y: "center" }) });
    this.view.focus();
  }

  // The number under the cursor, with its place in the text.
  number() {
    const { head } = this.view.state.selection.main;
    const line = this.view.state.doc.lineAt(head);
    return placed(line, numberAt(line.text, head - line.from));
  }

  // The number at a line and a column of a message, or the first after it.
  numberFrom(row, column) {
    if (!row || row > this.view.state.doc.lines) return null;
    const line = this.view.state.doc.line(row);
    return placed(line, numberAt(line.text, (column ?? 1) - 1, false));
  }

  complete(context) {
    if (!this.schema) return null;
    const { path, word, isValue, isHeader } = contextAt(context.state.doc.toString(), context.pos);
    if (!word && !context.explicit) return null;
    const options = isValue
      ? this.schema.values(path).map(({ word: label, meaning }) => ({
          label: typeof label === "string" ? `"${label}"` : String(label),
          info: meaning,
          type: "constant",
        }))
      : this.schema.keys(isHeader ? [] : path).map(({ key, meaning }) => ({ label: key, info: meaning, type: "property" }));
    return { from: context.pos - word.length, options, validFor: /^[\w."]*$/ };
  }

  hover(view, position) {
    const line = view.state.doc.lineAt(position);
    const column = position - line.from;
    const key = [...line.text.matchAll(/[\w.]+(?=\s*=)/g)].find((one) => one.index <= column && column <= one.index + one[0].length);
    if (!this.schema || !key) return null;
    const end = line.from + key.index + key[0].length;
    const { path, word } = contextAt(view.state.doc.toString(), end);
    const meaning = this.schema.meaning([...path, word]);
    if (!meaning) return null;
    const create = () => {
      const dom = document.createElement("div");
      dom.className = "meaning";
      dom.textContent = meaning;
      return { dom };
    };
    return { pos: line.from + key.index, end, create };
  }
}

function placed(line, number) {
  if (!number) return null;
  const key = /^\s*([\w.]+)\s*=/.exec(line.text)?.[1] ?? "";
  return { ...number, from: line.from + number.from, to: line.from + number.to, key };
}
