import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import type { Setting } from '../api/types';
import { decodeBits, encodeBits, flipBit, isSame, kindOf, meaningOf, optionsOf, problemOf } from './value';

const words = { on: 'on', off: 'off', none: 'none' };
const axes = ['X', 'Y', 'Z'];
const setting = (type_name: string, more: Partial<Setting> = {}): Setting => ({
  id: '1',
  value: '0',
  name: '',
  unit: '',
  group_id: 0,
  group: '',
  type: 0,
  type_name,
  format: '',
  min: '',
  max: '',
  reboot_required: false,
  allow_null: false,
  help: '',
  meaning: '',
  range: '',
  ...more,
});

describe('each type', () => {
  it.each([
    ['Bool', 'switch', '1', 'on'],
    ['Bitfield', 'bits', '5', 'A, C'],
    ['ExclusiveBitfield', 'bits', '3', 'A, B'],
    ['Axes', 'bits', '5', 'X, Z'],
    ['Radio', 'choice', '1', 'B'],
    ['Integer', 'number', '25', '25'],
    ['Decimal', 'number', '0.5', '0.5'],
    ['Text', 'text', 'abc', 'abc'],
    ['Password', 'password', 'secret', '••••••'],
    ['IPv4', 'address', '10.0.0.1', '10.0.0.1'],
    ['SomethingNew', 'text', 'x', 'x'],
  ])('%s', (type, kind, value, meaning) => {
    const one = setting(type, { format: 'A,B,C' });
    expect(kindOf(one)).toBe(kind);
    expect(meaningOf(one, value, axes, words)).toBe(meaning);
    expect(problemOf(one, value)).toBe('');
  });

  it('bits that are not in use are not offered', () => {
    expect(optionsOf(setting('Bitfield', { format: 'A,N/A,C' }), axes)).toEqual([
      { value: 0, title: 'A' },
      { value: 2, title: 'C' },
    ]);
  });
});

it('bits: decode after encode is the same set', () => {
  fc.assert(
    fc.property(fc.uniqueArray(fc.integer({ min: 0, max: 40 })), (bits) => {
      expect([...(decodeBits(encodeBits(bits)) ?? [])].sort((a, b) => a - b)).toEqual([...bits].sort((a, b) => a - b));
    }),
  );
  expect(decodeBits('a')).toBeUndefined();
});

it('bit 0 of an exclusive field takes the others with it, and they bring it', () => {
  const one = setting('ExclusiveBitfield', { format: 'Enable,B,C' });
  expect(flipBit(one, '7', 0)).toBe('0');
  expect(flipBit(one, '0', 2)).toBe('5');
  expect(flipBit(one, '5', 2)).toBe('1');
  expect(flipBit(setting('Bitfield'), '0', 2)).toBe('4');
});

it.each([
  ['Integer', '1.5', {}, 'notWhole'],
  ['Integer', 'x', {}, 'notNumber'],
  ['Integer', '1e3', {}, 'notNumber'],
  ['Decimal', '1', { min: '2.0' }, 'tooSmall'],
  ['Decimal', '9', { max: '8' }, 'tooLarge'],
  ['Decimal', '0', { min: '0.5', allow_null: true }, ''],
  ['Text', 'ü', {}, 'notAscii'],
  ['Password', 'abc', { min: '8' }, 'tooShort'],
  ['Text', 'abcd', { max: '3' }, 'tooLong'],
  ['IPv4', '1.2.3.256', {}, 'notAddress'],
  ['IPv4', '1.2.3', {}, 'notAddress'],
])('%s %s: %j gives "%s"', (type, value, more, problem) => {
  expect(problemOf(setting(type, more), value)).toBe(problem);
});

it('another spelling of a number is no change', () => {
  expect(isSame(setting('Decimal'), '5.0', '5')).toBe(true);
  expect(isSame(setting('Text'), '5.0', '5')).toBe(false);
  expect(isSame(setting('Decimal'), '', '0')).toBe(false);
});
