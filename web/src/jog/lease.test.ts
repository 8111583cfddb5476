import fc from 'fast-check';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { JogLease, renewEvery_ms } from './lease';

const order = { machine: 'm', direction: { X: 1 }, feed_mm_per_min: 500 };
let sent: { type: string }[];
let isOpen: boolean;
let lease: JogLease;

beforeEach(() => {
  vi.useFakeTimers();
  sent = [];
  isOpen = true;
  lease = new JogLease((message) => {
    if (isOpen) sent.push(message as { type: string });
    return isOpen;
  });
});
afterEach(() => void vi.useRealTimers());

const typesSent = () => sent.map((one) => one.type);

it('presses, renews every 50 ms and releases once', () => {
  lease.press(order, 'a');
  vi.advanceTimersByTime(3 * renewEvery_ms);
  lease.release();
  lease.release();
  vi.advanceTimersByTime(1000);
  expect(typesSent()).toEqual(['jog', 'jog-renew', 'jog-renew', 'jog-renew', 'jog-release']);
});

it('a second press lets go of the first', () => {
  lease.press(order, 'a');
  lease.press(order, 'b');
  expect(typesSent()).toEqual(['jog', 'jog-release', 'jog']);
});

it('does not begin without a socket, and does not go on when a lease was not given', () => {
  isOpen = false;
  lease.press(order, 'a');
  expect(lease.isHeld).toBe(false);
  isOpen = true;
  lease.press(order, 'b');
  lease.answered('b', false);
  expect(lease.isHeld).toBe(false);
});

it('an answer to an earlier press does not end a later one', () => {
  lease.press(order, 'a');
  lease.press(order, 'b');
  lease.answered('a', false);
  expect(lease.isHeld).toBe(true);
});

it('no sequence of presses, releases and losses leaves renewals running', () => {
  const step = fc.constantFrom('press', 'release', 'lost', 'refused', 'close', 'open', 'wait');
  const end = fc.constantFrom('release', 'lost', 'close');
  fc.assert(
    fc.property(fc.array(step, { maxLength: 40 }), end, (steps, last) => {
      isOpen = true;
      let key = 0;
      for (const one of [...steps, last]) {
        if (one === 'press') lease.press(order, String(++key));
        else if (one === 'release') lease.release();
        else if (one === 'lost') lease.lost();
        else if (one === 'refused') lease.answered(String(key), false);
        else if (one === 'wait') vi.advanceTimersByTime(120);
        else isOpen = one === 'open';
      }
      // A socket that closed in silence is noticed by the renewal that does not leave.
      vi.advanceTimersByTime(renewEvery_ms);
      expect(lease.isHeld).toBe(false);
      expect(vi.getTimerCount()).toBe(0);
      isOpen = true;
      const before = sent.length;
      vi.advanceTimersByTime(5000);
      expect(sent.length).toBe(before);
    }),
    { numRuns: 500 },
  );
});
