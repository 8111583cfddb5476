// A gamepad jogs while its dead-man button (a shoulder) is held and a stick is out of its middle. Nothing else does.

import type { AxisDirection } from '../api/types';
import { press, release } from './jog.svelte';
import { sameDirection } from './keys';

const deadZone = 0.45;
const deadMan = [4, 5];

const sign = (value: number | undefined): number =>
  value === undefined || Math.abs(value) < deadZone ? 0 : Math.sign(value);

/** Left stick or pad: X and Y. Right stick up and down: Z. Without the dead-man button nothing. */
export function directionOfPad(pad: {
  axes: readonly number[];
  buttons: readonly { pressed: boolean }[];
}): AxisDirection | undefined {
  if (!deadMan.some((button) => pad.buttons[button]?.pressed)) return undefined;
  const held = (button: number) => (pad.buttons[button]?.pressed ? 1 : 0);
  const all: Record<string, number> = {
    X: sign(pad.axes[0]) || held(15) - held(14),
    Y: -sign(pad.axes[1]) || held(12) - held(13),
    Z: -sign(pad.axes[3]),
  };
  const moving = Object.entries(all).filter(([, value]) => value !== 0);
  return moving.length > 0 ? Object.fromEntries(moving) : undefined;
}

class Gamepad {
  name = $state('');
  private direction: AxisDirection | undefined;

  listen(): () => void {
    const timer = setInterval(() => this.look(), 20);
    return () => {
      clearInterval(timer);
      this.turn(undefined);
    };
  }

  private look(): void {
    const pad = navigator.getGamepads?.().find((one) => one?.connected);
    const name = pad?.id ?? '';
    if (name !== this.name) this.name = name;
    this.turn(pad && document.hasFocus() ? directionOfPad(pad) : undefined);
  }

  private turn(direction: AxisDirection | undefined): void {
    if (sameDirection(direction, this.direction)) return;
    this.direction = direction;
    if (direction) press(direction);
    else release();
  }
}

export const gamepad = new Gamepad();
