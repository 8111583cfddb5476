import { expect, it } from 'vitest';
import { directionOfPad } from './gamepad.svelte';
import { directionOf, isJogKey } from './keys';

it('adds up the keys that are down', () => {
  expect(directionOf(['ArrowLeft', 'ArrowUp'])).toEqual({ X: -1, Y: 1 });
  expect(directionOf(['PageDown'])).toEqual({ Z: -1 });
  expect(directionOf(['ArrowLeft', 'ArrowRight'])).toBeUndefined();
  expect(directionOf(['KeyA'])).toBeUndefined();
  expect(isJogKey('Space')).toBe(false);
});

it('a gamepad does nothing without its dead-man button', () => {
  const axes = [1, 0, 0, 0];
  const buttons = (held: number) => Array.from({ length: 16 }, (_, at) => ({ pressed: at === held }));
  expect(directionOfPad({ axes, buttons: buttons(-1) })).toBeUndefined();
  expect(directionOfPad({ axes, buttons: buttons(4) })).toEqual({ X: 1 });
  expect(directionOfPad({ axes: [0.2, 0.1, 0, 0], buttons: buttons(5) })).toBeUndefined();
});
