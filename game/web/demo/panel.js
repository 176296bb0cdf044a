// Live figures: the cost of a step, and what each hand does.
import { HH_GRIP_AUTHORED, HH_GRIP_HELD, HH_GRIP_NONE, HH_GRIP_PLAYER, HH_GRIP_SURFACE } from 'handhold';

const gripNames = { [HH_GRIP_NONE]: 'open', [HH_GRIP_SURFACE]: 'holds on to', [HH_GRIP_HELD]: 'holds', [HH_GRIP_AUTHORED]: 'holds', [HH_GRIP_PLAYER]: 'holds a player' };
const k_shown = 90; // frames in the medians
function keep(list, value) {
    list.push(value);
    if (list.length > k_shown) {
        list.shift();
    }
}
function median(list) {
    return list.toSorted((a, b) => a - b)[Math.floor(list.length / 2)] ?? 0;
}

export class Panel {
    #table = document.getElementById('figures');
    #names;
    #steps_us = [];
    #frames_ms = [];
    #frames = 0;

    constructor(names) {
        this.#names = names;
    }
    get frames() {
        return this.#frames;
    }
    /** Median time of the last steps, microseconds. */
    get median_us() {
        return median(this.#steps_us);
    }
    /** frame_ms: what the last frame cost with drawing. more: further rows, shown first. */
    update(world, pose, speed_mps, frame_ms, more = []) {
        keep(this.#steps_us, world.stats().step_us);
        keep(this.#frames_ms, frame_ms);
        if (++this.#frames % 15 !== 0) {
            return;
        }
        const stats = world.stats();
        const hand = ({ grip, body, is_closed }) =>
            grip === HH_GRIP_NONE ? (is_closed ? 'closed, grips nothing' : 'open') : `${gripNames[grip]} ${this.#names.get(body.index) ?? ''}`;
        const rows = [
            ...more,
            ['step, median', `${(1e-3 * this.median_us).toFixed(2)} ms`],
            ['frame cost', `${median(this.#frames_ms).toFixed(2)} ms`],
            ['speed', `${speed_mps.toFixed(2)} m/s`],
            ['hand error', `${(1e3 * Math.max(...pose.hands.map(({ grip, error_m }) => (grip === HH_GRIP_NONE ? 0 : error_m)))).toFixed(4)} mm`],
            ['contacts', stats.contacts],
            ['left', hand(pose.hands[0])],
            ['right', hand(pose.hands[1])],
        ];
        this.#table.replaceChildren(...rows.map((cells) => {
            const row = document.createElement('tr');
            row.append(...cells.map((text) => Object.assign(document.createElement('td'), { textContent: text })));
            return row;
        }));
    }
}
