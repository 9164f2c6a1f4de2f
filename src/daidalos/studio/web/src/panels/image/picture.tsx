// The pictures of a topic on a canvas, and what is drawn over them.
import { useSignal, type Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { Studio } from "../../app/studio";
import { isRecord, isString } from "../../app/stored";
import type { CompressedImage, Image } from "../../generated/sensor_msgs";
import { Choice } from "../../ui/editors";
import { Empty } from "../../ui/empty";
import type { PanelProps } from "../panel";
import { decodeImage, ImageError } from "./decode";

const TYPES = ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"];

/** The topic of a panel of pictures: that of its display where it belongs to one, else its own; and how to change it. */
export function useTopic({ studio, params, remember }: PanelProps): [string, (topic: string) => void] {
  const own = useSignal(isRecord(params) && isString(params.topic) ? params.topic : "");
  const first = studio.session.topics.value.find(({ type }) => TYPES.includes(type))?.name ?? "";
  const display = displayOf(studio, params);
  useEffect(() => {
    if (!display && !own.value && first) {
      own.value = first;
    }
  }, [first]);
  const choose = (topic: string) => {
    if (display) {
      studio.displays.set(display.id, "topic", topic);
    } else {
      own.value = topic;
      remember({ topic });
    }
  };
  return [display ? String(display.settings.topic ?? "") : own.value, choose];
}

/** The display of the 3-D view that a panel belongs to. */
export function displayOf(studio: Studio, params: unknown) {
  const id = isRecord(params) ? params.display : undefined;
  return studio.displays.configs.find((config) => config.id === id);
}

interface PictureProps {
  studio: Studio;
  topic: string;
  visible: PanelProps["visible"];
  onChoose(topic: string): void;
  /** Called for each picture that was drawn. */
  onDrawn?(image: Image | CompressedImage): void;
  /** A note beside the topic. */
  note?: Signal<string>;
  children?: ComponentChildren;
}

export function Picture({ studio: { session }, topic, visible, onChoose, onDrawn, note, children }: PictureProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const caption = useSignal("");
  const errorText = useSignal("");
  const topics = session.topics.value.filter(({ type }) => TYPES.includes(type));
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
            onDrawn?.(image);
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
          onChange={onChoose}
        />
        <span class="faint figures">{caption.value}</span>
        {note?.value && <span class="faint ellipsis">{note.value}</span>}
      </div>
      <div class="image-area">
        <canvas ref={canvas} class={caption.value ? "" : "hidden"} role="img" aria-label={`Image of ${topic}`} />
        {children}
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
