// The worker: owns the WebSocket, decodes, and sends the page a batch whenever it is ready for one.
/// <reference lib="webworker" />
import type { FromWorker, ToWorker } from "./boundary";
import { SUBPROTOCOLS } from "../generated/protocol";
import { Link } from "./link";

const RETRY_FIRST_MS = 300;
const RETRY_LAST_MS = 4000;
const MEASURE_MS = 1000;
const BATCH_MS = 8;
const BATCH_HIDDEN_MS = 1000;
/** After how long without a word the server is asked for one, and how long its answer may take [ms]. */
const ASK_MS = 1500;
const ANSWER_MS = 1500;

declare const self: DedicatedWorkerGlobalScope;

let socket: WebSocket | undefined;
let retryMs = RETRY_FIRST_MS;
let pageIsReady = true;
let flushIsDue = false;
let flushedAt = 0;
let batchMs = BATCH_MS;
let heardAt = 0;
let isSilent = false;
let askedAt: number | undefined;
/** Whether the server of the page is that of the data, which can be asked over HTTP whether it lives. */
let canAsk = false;

const link = new Link({
  toServer(frame) {
    if (socket?.readyState === WebSocket.OPEN) {
      socket.send(frame);
    }
  },
  toPage,
});

function toPage(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, transfer);
}

self.onmessage = (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  if (message.kind === "open") {
    open(message.url);
  } else if (message.kind === "ready") {
    pageIsReady = true;
    flushSoon();
  } else if (message.kind === "visible") {
    batchMs = message.visible ? BATCH_MS : BATCH_HIDDEN_MS;
    flush();
  } else {
    link.receivePage(message);
  }
};

function open(url: string): void {
  toPage({ kind: "link", state: "connecting" });
  canAsk = new URL(url).host === self.location.host;
  socket = new WebSocket(url, [...SUBPROTOCOLS]);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    retryMs = RETRY_FIRST_MS;
    [heardAt, isSilent] = [performance.now(), false];
    toPage({ kind: "link", state: "connected" });
  };
  socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
    hear();
    if (typeof event.data === "string") {
      link.receiveText(event.data);
    } else {
      link.receiveBinary(event.data);
      flushSoon();
    }
  };
  socket.onclose = (event) => {
    toPage({ kind: "link", state: "lost", reason: event.reason });
    link.reset();
    setTimeout(() => open(url), retryMs);
    retryMs = Math.min(RETRY_LAST_MS, retryMs * 1.6);
  };
}

function hear(): void {
  heardAt = performance.now();
  if (isSilent) {
    isSilent = false;
    toPage({ kind: "link", state: "connected" });
  }
}

/** Notice a server that is there and says nothing, as one that was stopped: its connections stay open. */
function listenForSilence(): void {
  const now = performance.now();
  if (!canAsk || socket?.readyState !== WebSocket.OPEN || now - heardAt < ASK_MS) {
    return;
  }
  if (askedAt === undefined) {
    askedAt = now;
    fetch("/arrangement.json", { method: "HEAD", cache: "no-store" })
      .then(hear, () => undefined)
      .finally(() => (askedAt = undefined));
  } else if (now - askedAt >= ANSWER_MS && !isSilent) {
    isSilent = true;
    toPage({ kind: "link", state: "silent" });
  }
}

function flushSoon(): void {
  if (pageIsReady && !flushIsDue && link.hasUpdate) {
    flushIsDue = true;
    // Messages are sent to the page in batches: many small ones would cost more.
    setTimeout(flush, flushedAt + batchMs - performance.now());
  }
}

function flush(): void {
  flushIsDue = false;
  if (link.hasUpdate && pageIsReady) {
    flushedAt = performance.now();
    pageIsReady = false;
    link.flush();
  }
}

setInterval(() => {
  link.measure(performance.now() / 1000);
  listenForSilence();
}, MEASURE_MS);
