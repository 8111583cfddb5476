import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import type { StateDocument } from '../api/types';
import { follow, mergePatch, nothingYet } from './follow';

const state = (x: number) =>
  ({
    server: { name: 'Kerf', version: '1', started_at: '' },
    machines: {},
    programs: {},
    x,
  }) as unknown as StateDocument;
const snapshot = (number: number, x = 0) => ({ type: 'snapshot' as const, number, clock_s: 0, state: state(x) });
const patch = (number: number, change: unknown) => ({ type: 'patch' as const, number, clock_s: 0, patch: change });

describe('merge patch (RFC 7396)', () => {
  it.each([
    [{ a: 'b' }, { a: 'c' }, { a: 'c' }],
    [{ a: 'b' }, { b: 'c' }, { a: 'b', b: 'c' }],
    [{ a: 'b', b: 'c' }, { a: null }, { b: 'c' }],
    [{ a: ['b'] }, { a: 'c' }, { a: 'c' }],
    [{ a: 'c' }, { a: ['b'] }, { a: ['b'] }],
    [{ a: { b: 'c' } }, { a: { b: 'd', c: null } }, { a: { b: 'd' } }],
    [{ a: [{ b: 'c' }] }, { a: [1] }, { a: [1] }],
    [
      ['a', 'b'],
      ['c', 'd'],
      ['c', 'd'],
    ],
    [{ a: 'foo' }, 'bar', 'bar'],
    [{}, { a: { bb: { ccc: null } } }, { a: { bb: {} } }],
  ])('%j with %j is %j', (target, change, result) => expect(mergePatch(target, change)).toEqual(result));

  it('leaves the old value as it was and shares what it does not touch', () => {
    const before = { a: { b: 1 }, c: { d: 2 } };
    const after = mergePatch(before, { a: { b: 3 } }) as typeof before;
    expect(before.a.b).toBe(1);
    expect(after.c).toBe(before.c);
  });
});

describe('following by number', () => {
  it('takes a snapshot and the patches behind it', () => {
    let { followed } = follow(nothingYet, snapshot(7));
    ({ followed } = follow(followed, patch(8, { x: 5 })));
    expect(followed).toEqual({ number: 8, document: state(5) });
  });

  it('asks anew when a number is missing, and when there is nothing to patch', () => {
    const { followed } = follow(nothingYet, snapshot(7));
    expect(follow(followed, patch(9, {})).gap).toBe(true);
    expect(follow(nothingYet, patch(1, {})).gap).toBe(true);
  });

  it('passes over what it already has', () => {
    const { followed } = follow(nothingYet, snapshot(7, 1));
    expect(follow(followed, patch(7, { x: 9 }))).toEqual({ followed, gap: false });
  });

  it('never shows a document that the server did not have, whatever is lost or doubled', () => {
    fc.assert(
      fc.property(fc.array(fc.integer({ min: 1, max: 30 }), { maxLength: 60 }), (numbers) => {
        let followed = follow(nothingYet, snapshot(0, 0)).followed;
        for (const number of numbers) {
          const result = follow(followed, patch(number, { x: number }));
          if (!result.gap) followed = result.followed;
          expect((followed.document as unknown as { x: number }).x).toBe(followed.number);
        }
      }),
    );
  });
});
