// Image: what a camera sees, raw or compressed.
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/image.css";

import { Picture, useTopic } from "./image/picture";

function ImagePanel(props: PanelProps) {
  const [topic, choose] = useTopic(props);
  return <Picture studio={props.studio} topic={topic} visible={props.visible} onChoose={choose} />;
}

export default {
  id: "image",
  title: "Image",
  icon: "image",
  many: true,
  mount: withPreact(ImagePanel),
} satisfies BuiltInPanel;
