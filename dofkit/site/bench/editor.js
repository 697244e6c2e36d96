// The editor of a scene: YAML in colours, faults where they are, with their correction, and words to complete.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { HighlightStyle, bracketMatching, syntaxHighlighting } from "@codemirror/language";
import { lintKeymap, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";

/** @typedef {{message: string, line: number, column: number, hint: string}} Fault */

const LOOKS = HighlightStyle.define([
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--key)" },
  { tag: [tags.string, tags.content], color: "var(--ink)" },
  { tag: tags.comment, color: "var(--quiet)", fontStyle: "italic" },
  { tag: [tags.punctuation, tags.separator, tags.squareBracket, tags.brace], color: "var(--quiet)" },
]);
const THEME = EditorView.theme({
  "&": { height: "100%", color: "var(--ink)", backgroundColor: "var(--paper)", fontSize: "14px" },
  "&.cm-focused": { outline: "2px solid var(--focus)", outlineOffset: "-2px" },
  ".cm-scroller": { fontFamily: "ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace", lineHeight: "1.55" },
  ".cm-content": { caretColor: "var(--ink)", padding: "8px 0" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-gutters": { backgroundColor: "var(--paper)", color: "var(--quiet)", border: "none" },
  ".cm-activeLine": { backgroundColor: "var(--shade)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { background: "var(--selected) !important" },
  ".cm-tooltip": { backgroundColor: "var(--paper)", color: "var(--ink)", border: "1px solid var(--line)" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--focus)", color: "var(--paper)" },
  ".cm-diagnostic-error": { borderLeftColor: "var(--bad)" },
  ".cm-diagnosticAction": { backgroundColor: "var(--focus)", color: "var(--paper)", fontSize: "14px", padding: "2px 8px" },
  ".cm-lintRange-error": { backgroundImage: "none", textDecoration: "underline wavy var(--bad)", textUnderlineOffset: "3px" },
});

/**
 * @param {HTMLElement} place @param {string} text
 * @param {() => void} changed is called after every change
 * @param {() => {names: string[], schema: any}} words for completion
 */
export function editor(place, text, changed, words) {
  // within a shadow root CodeMirror's styles are adopted style sheets, which the page's policy allows
  const root = place.attachShadow({ mode: "open" });
  const state = EditorState.create({
    doc: text,
    extensions: [
      lineNumbers(), history(), drawSelection(), bracketMatching(), closeBrackets(), highlightActiveLine(),
      EditorView.lineWrapping, yaml(), syntaxHighlighting(LOOKS), THEME,
      autocompletion({ override: [(context) => completions(context, words())] }),
      keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap]),
      EditorView.contentAttributes.of({ "aria-label": "The scene, in YAML", spellcheck: "false", tabindex: "0" }),
      EditorView.updateListener.of((update) => update.docChanged && changed()),
    ],
  });
  const view = new EditorView({ state, parent: root, root });
  scrollToMechanism(view);
  return view;
}

/** Put another text in place of all. @param {EditorView} view @param {string} text */
export function replaceText(view, text) {
  view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text }, selection: { anchor: 0 } });
  scrollToMechanism(view);
}

/** Show first what a small editor has no room for below the notes: what moves, and its constraints. */
function scrollToMechanism(view) {
  const start = Math.max(0, view.state.doc.toString().search(/^(parameters|particles|bodies|coordinates):/m));
  view.requestMeasure({
    read: () => view.lineBlockAt(start).top,
    write: (top) => { view.scrollDOM.scrollTop = top; },
  });
}

/** The faults with their places in the text, and with the correction of a misspelt name. */
export function located(doc, faults) {
  return faults.map((/** @type {Fault} */ fault) => {
    const line = doc.line(Math.min(Math.max(fault.line, 1), doc.lines));
    const before = [...line.text].slice(0, fault.column - 1).join("").length;
    const from = Math.min(line.from + before, line.to);
    const word = /^[\p{L}\p{N}_'-]+/u.exec(line.text.slice(from - line.from))?.[0] ?? "";
    const to = Math.min(line.to, from + Math.max(word.length, 1));
    const meant = /did you mean [`'"]([^`'"]+)[`'"]/.exec(fault.hint)?.[1];
    const wrong = [...fault.message.matchAll(/[`']([^`']+)[`']/g)].map(([, name]) => name)
      .find((name) => line.text.startsWith(name, from - line.from));
    const mend = meant && wrong ? { from, to: from + wrong.length, insert: meant } : null;
    return { ...fault, from: from === to ? Math.max(line.from, from - 1) : from, to, mend };
  });
}

/** Underline faults. @param {EditorView} view */
export function underline(view, faults) {
  const diagnostics = faults.map(({ from, to, message, hint, mend }) => ({
    from, to, severity: "error", message: hint ? `${message} (${hint})` : message,
    actions: mend ? [{ name: `write ${mend.insert}`, apply: (v) => v.dispatch({ changes: mend }) }] : [],
  }));
  view.dispatch(setDiagnostics(view.state, diagnostics));
}

/** Keys at the beginning of a line, types after `type:`, and within an entry its fields and the declared names. */
function completions(context, { names, schema }) {
  const word = context.matchBefore(/[\p{L}\p{N}_]+/u);
  if ((!word && !context.explicit) || !schema) return null;
  const line = context.state.doc.lineAt(context.pos);
  const from = word?.from ?? context.pos;
  const before = line.text.slice(0, from - line.from);
  if (/type:\s*["']?$/.test(before)) return { from, options: types(schema).map((label) => ({ label, type: "type" })) };
  const quoted = before.split('"').length % 2 === 0;
  const outer = before.trim() === "" && !/^\s/.test(line.text);
  const keys = outer ? schema.properties : quoted ? {} : fields(schema, line.text, before);
  const options = Object.entries(keys).map(([label, { description }]) => ({
    label, type: "property", apply: `${label}: `, info: description,
  }));
  if (!outer) options.push(...names.map((label) => ({ label, type: "variable", boost: -1 })));
  return { from, options, validFor: /^[\p{L}\p{N}_]*$/u };
}

function types(schema) {
  return Object.values(schema.$defs).flatMap((part) => part.properties?.type?.enum ?? []);
}

function fields(schema, line, before) {
  const type = /type:\s*["']?(\w+)/.exec(line)?.[1];
  const known = Object.values(schema.$defs).find((part) => part.properties?.type?.enum?.includes(type));
  return known?.properties ?? (/[{,-]\s*$/.test(before) ? { name: {}, type: {}, text: {} } : {});
}
