// The WebSocket: opens it, opens it again, and says when the server cannot be reached. It keeps no state document.

import type { ServerFrame } from './types';

export interface ConnectionEvents {
  onFrame: (frame: ServerFrame) => void;
  onOpen: () => void;
  onLost: () => void;
  /** The number to go on from; negative asks for a snapshot. */
  resumeFrom: () => number;
}

const leastDelay_ms = 250;
const mostDelay_ms = 4000;
const quiet_ms = 4000;

export class Connection {
  private socket: WebSocket | null = null;
  private delay_ms = leastDelay_ms;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private heardAt = 0;

  constructor(private readonly events: ConnectionEvents) {}

  open(): void {
    clearTimeout(this.timer);
    const from = this.events.resumeFrom();
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${scheme}://${location.host}/api/v1/live${from >= 0 ? `?from=${from}` : ''}`);
    this.socket = socket;
    this.heardAt = Date.now();
    socket.onopen = () => {
      if (this.socket !== socket) return;
      this.delay_ms = leastDelay_ms;
      this.events.onOpen();
    };
    socket.onmessage = (message) => {
      if (this.socket !== socket) return;
      this.heardAt = Date.now();
      this.events.onFrame(JSON.parse(String(message.data)) as ServerFrame);
    };
    socket.onclose = () => this.lose(socket);
    socket.onerror = () => socket.close();
  }

  /** False if it did not leave. */
  send(message: object): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  /** Asks for a new snapshot by starting over. */
  startOver(): void {
    const old = this.socket;
    this.socket = null;
    old?.close();
    this.open();
  }

  /** A socket can be dead without saying so: after a silence the server is asked by another way. */
  async probe(): Promise<void> {
    const socket = this.socket;
    if (socket?.readyState !== WebSocket.OPEN || Date.now() - this.heardAt < quiet_ms) return;
    try {
      const answer = await fetch('/api/v1/ports', { signal: AbortSignal.timeout(2500), cache: 'no-store' });
      await answer.text();
    } catch {
      this.lose(socket);
    }
  }

  private lose(socket: WebSocket): void {
    if (this.socket !== socket) return;
    this.socket = null;
    socket.close();
    this.events.onLost();
    this.timer = setTimeout(() => this.open(), this.delay_ms);
    this.delay_ms = Math.min(this.delay_ms * 2, mostDelay_ms);
  }
}
