// Image: what a camera sees, raw or compressed.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { isRecord } from "../app/stored";
import type { CompressedImage, Image } from "../generated/sensor_msgs";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/image.css";

import { decodeImage, ImageError } from "./image/decode";

const TYPES = ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"];

function ImagePanel({ studio, visible, params, remember }: PanelProps) {
  const { session } = studio;
  const topics = session.topics.value.filter(({ type }) => TYPES.includes(type));
  const chosen = useSignal(isRecord(params) && typeof params.topic === "string" ? params.topic : "");
  const first = topics[0]?.name ?? "";
  useEffect(() => {
    if (!chosen.value && first) {
      chosen.value = first;
    }
  }, [first]);
  const topic = chosen.value;
  const canvas = useRef<HTMLCanvasElement>(null);
  const caption = useSignal("");
  const errorText = useSignal("");
  useEffect(() => {
    if (!visible.value || !topic) {
      return undefined;
    }
    let drawing = false;
    caption.value = errorText.value = "";
    return session.subscribe<Image | CompressedImage>(topic, 1, (image) => {
      // Decoding takes longer than the period: skip this image.
      if (!drawing) {
        drawing = true;
        draw(canvas.current, image)
          .then((text) => {
            caption.value = text;
            errorText.value = "";
          })
          .catch((error: Error) => {
            errorText.value = error instanceof ImageError ? error.message : `${topic}: the image cannot be decoded`;
          })
          .finally(() => (drawing = false));
      }
    });
  }, [topic, visible.value]);
  return (
    <div class="column">
      <div class="bar">
        <Choice
          label="Image topic"
          value={topic}
          options={topics.map(({ name }) => [name, name])}
          onChange={(name) => {
            chosen.value = name;
            remember({ topic: name });
          }}
        />
        <span class="faint figures">{caption.value}</span>
      </div>
      <div class="image-area">
        <canvas ref={canvas} class={caption.value ? "" : "hidden"} />
        {!topic && (
          <Empty icon="image" title="No camera">
            No topic carries images.
          </Empty>
        )}
        {topic && !caption.value && <Empty icon="image" title={errorText.value || `Nothing on ${topic} yet`} />}
      </div>
    </div>
  );
}

async function draw(canvas: HTMLCanvasElement | null, image: Image | CompressedImage): Promise<string> {
  const bitmap = await decodeImage(image);
  if (canvas) {
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
    }
    canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
  }
  bitmap.close();
  return `${bitmap.width || canvas?.width} × ${bitmap.height || canvas?.height}`;
}

export default {
  id: "image",
  title: "Image",
  icon: "image",
  many: true,
  mount: withPreact(ImagePanel),
} satisfies BuiltInPanel;
