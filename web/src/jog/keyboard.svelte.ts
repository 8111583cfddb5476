// The keyboard jogs only while it is armed, and nobody can forget that it is: it disarms itself.

import { prefs } from '../state/prefs.svelte';
import { directionOf, isJogKey, sameDirection } from './keys';
import { chosenFeed, press, release, step } from './jog.svelte';

const idle_ms = 30_000;
const fast = 4;

const typing = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName));

class Keyboard {
  armed = $state(false);
  private down = new Set<string>();
  private timer: ReturnType<typeof setTimeout> | undefined;

  arm(): void {
    this.armed = true;
    this.stayAwake();
  }

  disarm(): void {
    clearTimeout(this.timer);
    this.down.clear();
    if (this.armed) release();
    this.armed = false;
  }

  listen(): () => void {
    const down = (event: KeyboardEvent) => this.keyDown(event);
    const up = (event: KeyboardEvent) => this.keyUp(event);
    const away = () => this.disarm();
    const hidden = () => document.visibilityState !== 'visible' && this.disarm();
    window.addEventListener('keydown', down, true);
    window.addEventListener('keyup', up, true);
    window.addEventListener('blur', away);
    document.addEventListener('visibilitychange', hidden);
    return () => {
      window.removeEventListener('keydown', down, true);
      window.removeEventListener('keyup', up, true);
      window.removeEventListener('blur', away);
      document.removeEventListener('visibilitychange', hidden);
      this.disarm();
    };
  }

  private keyDown(event: KeyboardEvent): void {
    if (!this.armed) return;
    if (event.key === 'Escape') return this.disarm();
    if (!isJogKey(event.code) || typing(event.target)) return;
    event.preventDefault();
    event.stopPropagation();
    this.stayAwake();
    if (event.repeat) return;
    const before = directionOf(this.down);
    this.down.add(event.code);
    const direction = directionOf(this.down);
    if (prefs.jogMode === 'step' || event.ctrlKey) {
      const only = directionOf([event.code]);
      if (only) step(only);
    } else this.turn(before, direction, event.shiftKey);
  }

  private keyUp(event: KeyboardEvent): void {
    if (!this.down.delete(event.code)) return;
    if (prefs.jogMode === 'step') return;
    // One key of two: the rest would be another motion that nobody asked for.
    release();
    this.down.clear();
  }

  private turn(before: ReturnType<typeof directionOf>, after: ReturnType<typeof directionOf>, isFast: boolean): void {
    if (sameDirection(before, after)) return;
    if (after) press(after, chosenFeed() * (isFast ? fast : 1));
    else release();
  }

  private stayAwake(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (this.down.size > 0 ? this.stayAwake() : this.disarm()), idle_ms);
  }
}

export const keyboard = new Keyboard();
