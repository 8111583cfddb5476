// The one store: the state document, whether it can be believed, and the way commands leave.

import { Connection } from '../api/connection';
import { post } from '../api/http';
import { newKey } from '../api/key';
import type { Answer, ServerFrame, StateDocument, TrafficLine } from '../api/types';
import { JogLease, type JogOrder } from '../jog/lease';
import { follow, nothingYet, type Followed } from './follow';
import { hint } from './hints.svelte';

const answerWithin_ms = 8000;
const trafficKept = 1000;

class Live {
  document = $state.raw<StateDocument | null>(null);
  connected = $state(false);
  everConnected = $state(false);
  lostAt = $state(0);
  client = $state('');
  jogging = $state(false);
  traffic = $state.raw<TrafficLine[]>([]);
  /** The page's own clock, moved on twice a second: ages are counted with it. */
  now_s = $state(0);
  private clockAhead_s = 0;
  private followed: Followed = nothingYet;
  private waiting = new Map<string, (answer: Answer) => void>();
  private watched: string | null = null;
  private readonly connection = new Connection({
    onFrame: (frame) => this.take(frame),
    onOpen: () => this.opened(),
    onLost: () => this.lost(),
    resumeFrom: () => this.followed.number,
  });
  readonly lease = new JogLease(
    (message) => this.connection.send(message),
    (held) => (this.jogging = held),
  );

  start(): void {
    this.connection.open();
    setInterval(() => {
      this.now_s = performance.now() / 1000 + this.clockAhead_s;
      void this.connection.probe();
    }, 500);
  }

  /** The answer; also when none comes, in a sentence of ours. */
  command(machine: string, command: string, more: object = {}): Promise<Answer> {
    const key = newKey();
    const answered = this.answerTo(key);
    if (!this.connection.send({ type: 'command', key, machine, command, ...more })) {
      this.settle({ type: 'answer', key, outcome: 'Invalid', reason: 'NotConnected' });
    }
    return answered.then((answer) => {
      if (answer.outcome !== 'Accepted') hint.refused(answer);
      return answer;
    });
  }

  /** Goes both ways at once under one key, so that it has one effect and a dead socket does not matter. */
  async stop(machine: string, command: 'Stop' | 'Abort'): Promise<boolean> {
    this.lease.release();
    const key = newKey();
    const bySocket = this.answerTo(key);
    const sent = this.connection.send({ type: 'command', key, machine, command });
    if (!sent) this.settle({ type: 'answer', key, outcome: 'Invalid', reason: 'NotConnected' });
    const byHttp = post<Answer>(`/machines/${encodeURIComponent(machine)}/commands`, { command, key });
    const ways = [bySocket, byHttp].map(async (way) => {
      if ((await way).outcome !== 'Accepted') throw new Error();
    });
    return Promise.any(ways).then(
      () => true,
      () => false,
    );
  }

  jog(order: JogOrder): void {
    const key = newKey();
    void this.answerTo(key).then((answer) => {
      this.lease.answered(key, answer.outcome === 'Accepted');
      if (answer.outcome !== 'Accepted') hint.refused(answer);
    });
    this.lease.press(order, key);
    if (!this.lease.isHeld) this.settle({ type: 'answer', key, outcome: 'Invalid', reason: 'NotConnected' });
  }

  /** Only one console is on the screen at a time. */
  watch(machine: string | null): void {
    if (machine !== this.watched) this.traffic = [];
    this.watched = machine;
    this.connection.send({ type: 'watch', traffic: machine ? [machine] : [] });
  }

  private answerTo(key: string): Promise<Answer> {
    return new Promise((resolve) => {
      this.waiting.set(key, resolve);
      setTimeout(() => this.settle({ type: 'answer', key, outcome: 'Invalid', reason: 'NoAnswer' }), answerWithin_ms);
    });
  }

  private settle(answer: Answer): void {
    this.waiting.get(answer.key)?.(answer);
    this.waiting.delete(answer.key);
  }

  private take(frame: ServerFrame): void {
    if ('clock_s' in frame) this.setClock(frame.clock_s);
    if (frame.type === 'hello') this.client = frame.client;
    else if (frame.type === 'answer') this.settle(frame);
    else if (frame.type === 'traffic') this.addTraffic(frame.machine, frame.lines);
    else {
      const { followed, gap } = follow(this.followed, frame);
      this.followed = gap ? nothingYet : followed;
      if (gap) return this.connection.startOver();
      this.document = followed.document;
      this.connected = true;
      this.everConnected = true;
    }
  }

  private addTraffic(machine: string, lines: TrafficLine[]): void {
    if (machine === this.watched) this.traffic = [...this.traffic, ...lines].slice(-trafficKept);
  }

  private setClock(clock_s: number): void {
    this.clockAhead_s = clock_s - performance.now() / 1000;
    this.now_s = clock_s;
  }

  private opened(): void {
    // What we hold counts again as soon as a frame says so; with nothing changed the server sends only its hello.
    this.connected = this.document !== null;
    if (this.watched) this.watch(this.watched);
  }

  private lost(): void {
    this.lease.lost();
    if (this.connected) this.lostAt = Date.now();
    this.connected = false;
    for (const key of [...this.waiting.keys()])
      this.settle({ type: 'answer', key, outcome: 'Invalid', reason: 'Lost' });
  }
}

export const live = new Live();
