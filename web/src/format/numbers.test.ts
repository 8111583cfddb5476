import fc from 'fast-check';
import { expect, it } from 'vitest';
import { duration, feed, position, size, typedLength } from './numbers';

it('shows positions with three places in mm and four in inches', () => {
  expect(position(12.34567, 'mm')).toBe('12.346');
  expect(position(25.4, 'inch')).toBe('1.0000');
  expect(position(-0.0001, 'mm')).toBe('0.000');
  expect(position(undefined, 'mm')).toBe('—');
  expect(feed(1000, 'inch')).toBe('39.4');
});

it('shows times as people read them', () => {
  expect(duration(245.2)).toBe('4:05');
  expect(duration(3729)).toBe('1:02:09');
  expect(duration(-1)).toBe('0:00');
  expect(duration(undefined)).toBe('—');
});

it('reads what a person types, in mm', () => {
  expect(typedLength('1,5', 'mm')).toBe(1.5);
  expect(typedLength('-.5', 'inch')).toBeCloseTo(-12.7);
  for (const odd of ['', '1e3', 'abc', '1.2.3', '--1']) expect(typedLength(odd, 'mm')).toBeUndefined();
});

it('a shown position reads back as the same to its last place', () => {
  fc.assert(
    fc.property(
      fc.double({ min: -5000, max: 5000, noNaN: true }),
      fc.constantFrom('mm' as const, 'inch' as const),
      (mm, units) => {
        expect(Math.abs((typedLength(position(mm, units), units) ?? NaN) - mm)).toBeLessThan(0.0015);
      },
    ),
  );
});

it('shows sizes', () => {
  expect(size(999, 'en')).toBe('999 B');
  expect(size(1_500_000, 'en')).toBe('1.5 MB');
});
