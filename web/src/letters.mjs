// Bytes as letters that may stand in a page: five for four bytes, where base64 takes four for three.

/** 85 letters, without those that mean something in HTML or in a script. */
const LETTERS = Array.from({ length: 94 }, (_, at) => String.fromCharCode(33 + at)).filter((it) => !"<&\\\"'`".includes(it)).slice(0, 85);

/** Bytes as letters; zeros fill the last four bytes. */
export function toLetters(/** @type {Uint8Array} */ bytes) {
  const padded = new Uint8Array(Math.ceil(bytes.length / 4) * 4);
  padded.set(bytes);
  const view = new DataView(padded.buffer);
  let out = "";
  for (let at = 0; at < padded.length; at += 4) {
    let rest = view.getUint32(at);
    let five = "";
    for (let times = 0; times < 5; times += 1) {
      five = LETTERS[rest % 85] + five;
      rest = Math.floor(rest / 85);
    }
    out += five;
  }
  return out;
}

/** As many of the bytes as there were. */
export function fromLetters(/** @type {string} */ text, /** @type {number} */ count) {
  const values = new Uint8Array(128);
  LETTERS.forEach((letter, value) => (values[letter.charCodeAt(0)] = value));
  const padded = new Uint8Array((text.length / 5) * 4);
  const view = new DataView(padded.buffer);
  for (let at = 0; at < text.length; at += 5) {
    let four = 0;
    for (let times = 0; times < 5; times += 1) four = four * 85 + (values[text.charCodeAt(at + times)] ?? 0);
    view.setUint32((at / 5) * 4, four);
  }
  return padded.subarray(0, count);
}
