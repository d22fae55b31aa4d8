// Files that leave the page.

/** Hands a text to the person as a file. */
export function saved(name: string, content: string | Blob, type = "text/plain"): void {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  const link = Object.assign(document.createElement("a"), { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** An archive that lies in a column, eight bytes in each number. */
export function archiveOf(column: Float64Array, bytes: number): Blob {
  return new Blob([new Uint8Array(column.buffer as ArrayBuffer, column.byteOffset, bytes)], { type: "application/zip" });
}

/** A figure as pixels, twice as fine as it is drawn, on white. */
export async function savedPng(name: string, svg: string): Promise<void> {
  const image = new Image();
  const loaded = new Promise((resolve, reject) => Object.assign(image, { onload: resolve, onerror: reject }));
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await loaded;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [2 * (image.naturalWidth || 720), 2 * (image.naturalHeight || 400)];
  const context = canvas.getContext("2d")!;
  context.fillStyle = "white";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (blob) saved(name, blob);
}
