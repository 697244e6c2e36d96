// A second checker of dofkit's certificates, which shares nothing with the first: another language, another
// arithmetic, another author, and the page `dofkit/checker/FORMAT.md` alone to go by.
//
// It reads lines of JSON, each { "document": a scene, "certificate": its certificate }, and writes one line of JSON for
// each: { "refused": why } where the whole is not in order, or { "claims": [[path, verdict, why], ...] }. A verdict is
// `accepted`, `refused`, or `not covered`: the rule, the type of constraint or an identity is beyond this checker. It
// never accepts what it cannot check.
//
//   numbers.mjs    rationals, and intervals that contain what they stand for
//   trees.mjs      expressions: derivatives, substitution, values
//   grammar.mjs    texts to trees
//   ring.mjs       normal forms: is an expression 0?
//   scene.mjs      a scene's relations
//   evidence.mjs   steps, points, minors, fields, covers
//   rules.mjs      the rules, claim by claim

import { createInterface } from "node:readline";
import { NotCovered, Refused, refuse } from "./numbers.mjs";
import * as ring from "./ring.mjs";
import * as trees from "./trees.mjs";
import { Evidence } from "./evidence.mjs";
import { Rules, check } from "./rules.mjs";
import { Scene, sha256Of } from "./scene.mjs";

/** The verdicts of all claims of a certificate. */
export function verdicts(document, certificate) {
  ring.reset();
  trees.reset();
  ring.restart();
  refuse(certificate?.certificate !== 1, "it is no certificate of version 1");
  refuse(certificate.scene?.sha256 !== sha256Of(document), "it is the certificate of another scene");
  const lists = ["relations", "points", "minors", "fields", "covers", "claims", "cayley", "uncovered"];
  for (const [key, part] of Object.entries(certificate)) {
    if (key === "certificate" || key === "scene") continue;
    refuse(!lists.includes(key) || !Array.isArray(part), `${key} cannot be read`);
    const kind = key === "cayley" || key === "uncovered" ? "string" : "object";
    refuse(part.some((one) => typeof one !== kind || one === null || Array.isArray(one)), `${key} cannot be read`);
  }
  const verified = new Map();
  const seen = new Set(certificate.uncovered ?? []);
  const readings = new Map();
  const reading = (cayley) => {
    if (!readings.has(cayley)) {
      const scene = new Scene(document, cayley ? (certificate.cayley ?? []) : []);
      readings.set(cayley, new Rules(new Evidence(scene, certificate), verified));
    }
    return readings.get(cayley);
  };
  return (certificate.claims ?? []).map((claim) => {
    ring.restart();
    try {
      const again = seen.has(String(claim.path));
      seen.add(String(claim.path));
      refuse(again, "it is claimed twice, or claimed and uncovered");
      const found = check(reading(claim.cayley === true), claim);
      verified.set(claim.path, { value: claim.value, about: claim.about, ...found });
      return [claim.path, "accepted", ""];
    } catch (error) {
      if (error instanceof NotCovered) {
        if (!verified.has(claim.path)) verified.set(claim.path, { value: claim.value, uncovered: true });
        return [claim.path, "not covered", error.message];
      }
      if (!(error instanceof Refused) && !(error instanceof TypeError) && !(error instanceof RangeError) && !(error instanceof SyntaxError)) throw error;
      return [claim.path, "refused", error.message];
    }
  });
}

function answer(line) {
  try {
    const { document, certificate } = JSON.parse(line);
    return { claims: verdicts(document, certificate) };
  } catch (error) {
    if (error instanceof NotCovered) return { uncovered: error.message };
    if (!(error instanceof Refused) && !(error instanceof TypeError) && !(error instanceof SyntaxError)) throw error;
    return { refused: error.message };
  }
}

for await (const line of createInterface({ input: process.stdin })) {
  if (line.trim()) process.stdout.write(`${JSON.stringify(answer(line))}\n`);
}
