import { expect, it } from 'vitest';
import { de } from './de';
import { en } from './en';
import { fill, type MessageKey } from './index.svelte';

const placeholders = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map((match) => match[1]).sort();

it('every language has every message, with the same places to fill', () => {
  expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
  for (const key of Object.keys(en) as MessageKey[]) {
    expect(de[key], key).not.toBe('');
    expect(placeholders(de[key]), key).toEqual(placeholders(en[key]));
  }
});

it('fills what it knows and leaves the rest', () => {
  expect(fill('{n} of {total}', { n: 3 })).toBe('3 of {total}');
});
