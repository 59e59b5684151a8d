// Where a name may break into lines: after `_` and other signs, between words in camel case, and in
// a long word between two consonants, with a hyphen.

export type NamePart = { text: string; hyphen: boolean };

// Shorter words stay whole.
const LONG = 9;
const PARTS = /(?<=[_>/.-])(?=[^_>/. -])|(?<=[a-z])(?=[A-Z])/;
// No less than three letters are at each side of a hyphen.
const SYLLABLES = /(?<=[a-z][aeiouy][bcdfghjklmnpqrstvwxz])(?=[bcdfghjklmnpqrstvwxz][aeiouy][a-z])/i;

export function nameParts(name: string): NamePart[] {
  return name.split(/(?<= )/).flatMap((word) =>
    word.split(PARTS).flatMap((part) => {
      const syllables = part.trim().length < LONG ? [part] : part.split(SYLLABLES);
      return syllables.map((text, i) => ({ text, hyphen: i < syllables.length - 1 }));
    }),
  );
}
