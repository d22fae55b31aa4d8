// Bytes as letters that may stand in a page: a letter for seven bits, where base64 takes one for six.
//
// Most values of seven bits are their own letter, of one byte in UTF-8. A value that may not stand in a page, or that a
// terminal would obey, makes one letter of two bytes with the seven bits behind it, so that nothing is lost.

/** Nothing, bell, back, tabulator, page, return, end of a file, escape, `&`, `<`, `>`, delete. */
const KEPT_OUT = [0x00, 0x07, 0x08, 0x0b, 0x0c, 0x0d, 0x1a, 0x1b, 0x26, 0x3c, 0x3e, 0x7f];
/** Behind the letters of one byte and their controls. */
const FIRST_PAIR = 0xa0;

/** Bytes as letters; zeros fill the last seven bits. */
export function toLetters(/** @type {Uint8Array} */ bytes) {
  const values = new Uint8Array(Math.ceil((bytes.length * 8) / 7));
  let [rest, bits, at] = [0, 0, 0];
  for (const byte of bytes) {
    rest = (rest << 8) | byte;
    for (bits += 8; bits >= 7; bits -= 7) values[at++] = (rest >> (bits - 7)) & 0x7f;
    rest &= 0x7f;
  }
  if (bits > 0) values[at] = (rest << (7 - bits)) & 0x7f;
  const out = [];
  for (let at = 0; at < values.length; at += 1) {
    const which = KEPT_OUT.indexOf(values[at] ?? 0);
    out.push(String.fromCharCode(which < 0 ? (values[at] ?? 0) : FIRST_PAIR + 128 * which + (values[++at] ?? 0)));
  }
  return out.join("");
}

/** As many of the bytes as there were. */
export function fromLetters(/** @type {string} */ text, /** @type {number} */ count) {
  const bytes = new Uint8Array(count);
  let [rest, bits, to] = [0, 0, 0];
  for (let at = 0; at < text.length; at += 1) {
    let value = text.charCodeAt(at);
    let more = 7;
    if (value >= FIRST_PAIR) {
      const pair = value - FIRST_PAIR;
      value = ((KEPT_OUT[pair >> 7] ?? 0) << 7) | (pair & 0x7f);
      more = 14;
    }
    rest = (rest << more) | value;
    // A place of the array takes the lowest eight bits; what lies beyond its end is left out.
    for (bits += more; bits >= 8; ) bytes[to++] = rest >> (bits -= 8);
    rest &= 0xff;
  }
  return bytes;
}
