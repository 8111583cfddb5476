// Hold-to-jog: a lease on the machine that lives only as long as it is renewed. Whatever ends the press ends the renewals.

import type { AxisDirection } from '../api/types';

export interface JogOrder {
  machine: string;
  direction: AxisDirection;
  feed_mm_per_min: number;
}

export const renewEvery_ms = 50;

export class JogLease {
  private held: { machine: string; key: string } | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;

  /** `send` is false when the message did not leave: then there is no lease. */
  constructor(
    private readonly send: (message: object) => boolean,
    private readonly changed: (held: boolean) => void = () => undefined,
  ) {}

  get isHeld(): boolean {
    return this.held !== null;
  }

  press(order: JogOrder, key: string): void {
    this.release();
    if (!this.send({ type: 'jog', key, ...order })) return;
    this.held = { machine: order.machine, key };
    this.timer = setInterval(() => this.renew(), renewEvery_ms);
    this.changed(true);
  }

  release(): void {
    const held = this.end();
    if (held) this.send({ type: 'jog-release', machine: held.machine });
  }

  /** The socket is gone, and the lease with it: the server has let go by itself. */
  lost(): void {
    this.end();
  }

  /** The server has answered; a lease that it did not give is not renewed. */
  answered(key: string, accepted: boolean): void {
    if (!accepted && this.held?.key === key) this.end();
  }

  private renew(): void {
    if (this.held && !this.send({ type: 'jog-renew', machine: this.held.machine })) this.end();
  }

  private end(): { machine: string } | null {
    const held = this.held;
    clearInterval(this.timer);
    this.timer = undefined;
    this.held = null;
    if (held) this.changed(false);
    return held;
  }
}
