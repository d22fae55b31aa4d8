// The boundary: a question as JSON into the memory of the mathematics, JSON and columns out of it.

/** What the mathematics exports; see `crates/fspid-web/src/boundary.rs`. */
interface Exports {
  memory: WebAssembly.Memory;
  fspid_room(bytes: number): number;
  fspid_ask(): void;
  fspid_answer_at(): number;
  fspid_answer_bytes(): number;
}

/** An answer: what JSON says, and columns that it names by their numbers. */
export interface Answer {
  json: any;
  columns: Float64Array[];
}

/** The mathematics, ready to be asked. */
export class Mathematics {
  readonly #exports: Exports;

  constructor(instance: WebAssembly.Instance) {
    this.#exports = instance.exports as unknown as Exports;
  }

  ask(question: object): Answer {
    const exports = this.#exports;
    const bytes = new TextEncoder().encode(JSON.stringify(question));
    const room = exports.fspid_room(bytes.length);
    new Uint8Array(exports.memory.buffer, room, bytes.length).set(bytes);
    exports.fspid_ask();
    return read(exports.memory.buffer, exports.fspid_answer_at(), exports.fspid_answer_bytes());
  }
}

/** Reads an answer and copies its columns, for the memory moves with the next question. */
function read(memory: ArrayBuffer, at: number, bytes: number): Answer {
  const view = new DataView(memory, at, bytes);
  const textBytes = view.getUint32(0, true);
  const count = view.getUint32(4, true);
  const lengths = Array.from({ length: count }, (_, column) => view.getUint32(8 + 4 * column, true));
  const textAt = 8 + 4 * count;
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(memory, at + textAt, textBytes)));
  let next = Math.ceil((textAt + textBytes) / 8) * 8;
  const columns = lengths.map((length) => {
    const column = new Float64Array(memory.slice(at + next, at + next + 8 * length));
    next += 8 * length;
    return column;
  });
  return { json, columns };
}
