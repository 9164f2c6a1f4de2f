// Camera: what a camera sees, with the scene of the 3-D view drawn over it as that camera sees it.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { PerspectiveCamera, WebGLRenderer } from "three";
import { attachedWorld } from "../app/test_hooks";
import type { CameraInfo, CompressedImage, Image } from "../generated/sensor_msgs";
import { frameOf, stampOf } from "../displays/message_filter";
import { beginsFine } from "../scene/graphics";
import { isCalibrated, setLens } from "../scene/lens";
import { Transform } from "../tf/buffer";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/image.css";

import { displayOf, Picture, useTopic } from "./image/picture";

const POSE = new Transform();
const EYE = new PerspectiveCamera();

function CameraPanel(props: PanelProps) {
  const { studio, visible } = props;
  const [topic, choose] = useTopic(props);
  const overlay = useRef<HTMLCanvasElement>(null);
  const renderer = useRef<WebGLRenderer | undefined>(undefined);
  const info = useRef<CameraInfo | undefined>(undefined);
  const note = useSignal("");
  useEffect(() => {
    const canvas = overlay.current as HTMLCanvasElement;
    renderer.current = new WebGLRenderer({ canvas, alpha: true, antialias: beginsFine, preserveDrawingBuffer: true });
    renderer.current.setClearColor(0, 0);
    return () => renderer.current?.dispose();
  }, []);
  useEffect(() => {
    info.current = undefined;
    return topic && visible.value
      ? studio.session.subscribe<CameraInfo>(infoTopic(topic), 1, (received) => (info.current = received))
      : undefined;
  }, [topic, visible.value]);
  const drawScene = (image: Image | CompressedImage) => {
    note.value = problem(image, info.current);
    const world = attachedWorld();
    if (note.value || !world || !info.current) {
      renderer.current?.clear();
      return;
    }
    setLens(EYE, info.current, POSE);
    renderer.current?.setSize(info.current.width, info.current.height, false);
    renderer.current?.render(world.viewport.scene, EYE);
  };
  const problem = (image: Image | CompressedImage, calibration: CameraInfo | undefined): string => {
    if (!attachedWorld()) {
      return "open the 3D panel for the overlay";
    }
    if (!calibration || !isCalibrated(calibration)) {
      return `no overlay: ${calibration ? "not calibrated" : `nothing on ${infoTopic(topic)} yet`}`;
    }
    const [fixed, frame, when] = [studio.fixedFrame.current.value, frameOf(image), stampOf(image)];
    return studio.tf.lookup(fixed, frame, when, POSE, { clamp: true }) ? "" : studio.tf.explain(fixed, frame, when);
  };
  const alpha = Number(displayOf(studio, props.params)?.settings.alpha ?? 0.5);
  return (
    <Picture studio={studio} topic={topic} visible={visible} onChoose={choose} onDrawn={drawScene} note={note}>
      <canvas ref={overlay} class="scene-overlay" style={{ opacity: alpha }} data-test="overlay" aria-hidden="true" />
    </Picture>
  );
}

/** Where a camera of image_transport publishes its calibration. */
function infoTopic(image: string): string {
  const base = image.endsWith("/compressed") ? image.slice(0, -"/compressed".length) : image;
  return `${base.slice(0, base.lastIndexOf("/"))}/camera_info`;
}

export default {
  id: "camera",
  title: "Camera",
  icon: "camera",
  many: true,
  mount: withPreact(CameraPanel),
} satisfies BuiltInPanel;
