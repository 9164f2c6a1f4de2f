// sensor_msgs' images as bitmaps: the encodings of cameras and of depth cameras.
import type { CompressedImage, Image } from "../../generated/sensor_msgs";
import { TURBO } from "../../scene/colors";

export class ImageError extends Error {}

export async function decodeImage(image: Image | CompressedImage): Promise<ImageBitmap> {
  if ("format" in image) {
    // compressed_depth_image_transport puts a header of 12 bytes before a PNG.
    const depth = image.format.includes("compressedDepth");
    return createImageBitmap(new Blob([(depth ? image.data.slice(12) : image.data) as Uint8Array<ArrayBuffer>]));
  }
  const pixels = toRgba(image);
  return createImageBitmap(new ImageData(pixels, image.width, image.height));
}

/** Convert a raw image to red, green, blue and alpha, one byte each. */
export function toRgba(image: Image): Uint8ClampedArray<ArrayBuffer> {
  const { width, height, encoding } = image;
  const bytes = bytesPerPixel(encoding);
  if (width < 1 || height < 1 || image.step < width * bytes || image.data.length < image.step * height) {
    throw new ImageError(`${image.data.length} bytes are no ${width} × ${height} ${encoding} image`);
  }
  const out = new Uint8ClampedArray(4 * width * height);
  switch (encoding) {
    case "rgb8":
    case "8UC3":
      return copyChannels(image, out, [0, 1, 2]);
    case "bgr8":
      return copyChannels(image, out, [2, 1, 0]);
    case "rgba8":
      return copyChannels(image, out, [0, 1, 2]);
    case "bgra8":
    case "8UC4":
      return copyChannels(image, out, [2, 1, 0]);
    case "mono8":
    case "8UC1":
      return copyChannels(image, out, [0, 0, 0]);
    default:
      return paintDepth(image, out);
  }
}

function bytesPerPixel(encoding: string): number {
  const known = {
    rgb8: 3,
    "8UC3": 3,
    bgr8: 3,
    rgba8: 4,
    bgra8: 4,
    "8UC4": 4,
    mono8: 1,
    "8UC1": 1,
    mono16: 2,
    "16UC1": 2,
    "32FC1": 4,
  }[encoding];
  if (known === undefined) {
    throw new ImageError(`encoding ${encoding} is not known`);
  }
  return known;
}

function copyChannels(image: Image, out: Uint8ClampedArray<ArrayBuffer>, order: readonly [number, number, number]) {
  const { width, height, step, data, encoding } = image;
  const bytes = bytesPerPixel(encoding);
  const [r, g, b] = order;
  let to = 0;
  for (let row = 0; row < height; row++) {
    for (let from = row * step, end = from + width * bytes; from < end; from += bytes, to += 4) {
      out[to] = data[from + r] as number;
      out[to + 1] = data[from + g] as number;
      out[to + 2] = data[from + b] as number;
      out[to + 3] = 255;
    }
  }
  return out;
}

/** Depth and other measured images: from the least to the greatest value, no value is black. */
function paintDepth(image: Image, out: Uint8ClampedArray<ArrayBuffer>) {
  const { width, height, step, data, encoding } = image;
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const little = !image.is_bigendian;
  const read =
    encoding === "32FC1" ? (at: number) => view.getFloat32(at, little) : (at: number) => view.getUint16(at, little);
  const bytes = bytesPerPixel(encoding);
  const values = new Float32Array(width * height);
  let [least, most] = [Infinity, -Infinity];
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const value = read(row * step + column * bytes);
      values[row * width + column] = value;
      if (value > 0 && Number.isFinite(value)) {
        least = Math.min(least, value);
        most = Math.max(most, value);
      }
    }
  }
  const scale = most > least ? 255 / (most - least) : 0;
  values.forEach((value, i) => {
    const known = value > 0 && Number.isFinite(value);
    if (encoding === "mono16") {
      out.fill(value / 257, 4 * i, 4 * i + 3);
    } else if (known) {
      const entry = 3 * Math.round((value - least) * scale);
      out.set(TURBO.subarray(entry, entry + 3), 4 * i);
    }
    out[4 * i + 3] = 255;
  });
  return out;
}
