// Foxglove's own client against a server of ours: does everything once and prints what it got as one JSON object.
// Started by tests/studio/test_partners.py; arguments: the server's address.
import protocol from "@foxglove/ws-protocol";
import { parse } from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import WebSocket from "ws";

const { FoxgloveClient } = protocol;
const { MessageReader, MessageWriter } = serialization;
const TIMEOUT_MS = 15_000;

setTimeout(() => {
  console.error("took too long");
  process.exit(1);
}, TIMEOUT_MS).unref();

const client = new FoxgloveClient({
  ws: new WebSocket(process.argv[2], [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
});
client.on("error", (error) => {
  console.error(error);
  process.exit(1);
});

/** The next event of a name for which a condition holds. */
function next(name, condition = () => true) {
  return new Promise((resolve) => {
    const listener = (event) => {
      if (condition(event)) {
        client.off(name, listener);
        resolve(event);
      }
    };
    client.on(name, listener);
  });
}

const bytes = (data) => Buffer.from(data.buffer ?? data, data.byteOffset ?? 0, data.byteLength);

const [info, channels, services] = await Promise.all([
  next("serverInfo"),
  next("advertise"),
  next("advertiseServices"),
]);
const result = { name: info.name, capabilities: info.capabilities };

const channel = channels.find(({ topic }) => topic === "/chatter");
const definition = parse(channel.schema, { ros2: true });
const subscription = client.subscribe(channel.id);
const { data, timestamp } = await next("message", ({ subscriptionId }) => subscriptionId === subscription);
result.message = new MessageReader(definition).readMessage(bytes(data));
result.stamp = String(timestamp);

const outgoing = client.advertise({ topic: "/answer", encoding: "cdr", schemaName: "std_msgs/msg/String" });
client.sendMessage(outgoing, new MessageWriter(definition).writeMessage({ data: "from Foxglove" }));

const service = services.find(({ name }) => name === "/flip");
const call = (callId, payload) =>
  client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: "cdr", data: new DataView(payload.buffer) });
call(1, new Uint8Array([1, 2, 3]));
result.response = [...bytes((await next("serviceCallResponse", ({ callId }) => callId === 1)).data)];
call(2, new Uint8Array([66, 65, 68]));
result.failure = (await next("serviceCallFailure", ({ callId }) => callId === 2)).message;

client.setParameters([{ name: "/node.speed", value: 0.75, type: "float64" }], "set");
result.parameters = (await next("parameterValues", ({ id }) => id === "set")).parameters;

client.subscribeConnectionGraph();
result.graph = (await next("connectionGraphUpdate")).publishedTopics;

client.fetchAsset("package://pkg/a.stl", 5);
result.asset = bytes((await next("fetchAssetResponse", ({ requestId }) => requestId === 5)).data).toString();
client.fetchAsset("package://pkg/none.stl", 6);
result.assetError = (await next("fetchAssetResponse", ({ requestId }) => requestId === 6)).error;

process.stdout.write(JSON.stringify(result), () => process.exit(0));
