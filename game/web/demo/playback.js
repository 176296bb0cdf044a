// A recorded session (docs/reference/recording_format.md) as samples of the library, frame by frame: as
// game/session/playback.cpp gives them to the native game, so paths and hashes are equal.

const k_grab = 2 | 4; // buttons that close the hand: trigger, grip
const k_menu = 8;

/** Samples with times from 0. A device that was not tracked has no pose. */
export function parseRecording(text) {
    const [header, ...lines] = text.split(/\r?\n/).filter((line) => line.trim() !== '').map((line) => line.trim());
    const names = header.split(',');
    let first_s;
    return lines.map((line) => {
        const cells = line.split(',').map(Number);
        const cell = Object.fromEntries(names.map((name, i) => [name, cells[i]]));
        const pose = (key) => ({
            position: { x: cell[key + 'x'], y: cell[key + 'y'], z: cell[key + 'z'] },
            rotation: { x: cell[key + 'qx'], y: cell[key + 'qy'], z: cell[key + 'qz'], w: cell[key + 'qw'] },
        });
        const isTracked = ({ position: p, rotation: q }) => [p.x, p.y, p.z, q.x, q.y, q.z, q.w].every((x) => !Number.isNaN(x)) && [q.x, q.y, q.z, q.w].some((x) => x !== 0);
        const hands = [pose('l'), pose('r')];
        const head = pose('h');
        first_s ??= cell.t;
        return {
            calibrate: (cell.lbtn & cell.rbtn & k_menu) !== 0,
            sample: {
                time_s: cell.t - first_s,
                head: isTracked(head) ? head : {}, head_tracked: isTracked(head),
                hands: hands.map((hand) => (isTracked(hand) ? hand : {})), hand_tracked: hands.map(isTracked),
                grab: [(cell.lbtn & k_grab) !== 0, (cell.rbtn & k_grab) !== 0], squeeze: [cell.ltrig, cell.rtrig], trigger: [cell.lindex ?? 0, cell.rindex ?? 0],
                head_inferred: cell.hinferred === 1, hand_inferred: [cell.linferred === 1, cell.rinferred === 1],
                curls: ['l', 'r'].map((side) => ({ fingers: ['thumb', 'index', 'middle', 'ring', 'little'].map((finger) => cell[`${side}curl_${finger}`] ?? -1) })),
            },
        };
    });
}

export class Playback {
    #samples;
    #next = 0; // first sample that was not yet given
    #begin_s;

    /** begin_s: the world's time at which the recording begins. */
    constructor(samples, begin_s = 0) {
        this.#samples = samples;
        this.#begin_s = begin_s;
    }
    get duration_s() {
        return this.#samples.at(-1).sample.time_s;
    }
    /** {samples, commands} of a step that ends at end_s: samples up to then, and the one after unless one lies exactly there. */
    read(end_s) {
        const time_s = end_s - this.#begin_s;
        const begin = this.#next;
        while (this.#next < this.#samples.length && this.#samples[this.#next].sample.time_s <= time_s) {
            ++this.#next;
        }
        const last = this.#samples[this.#next - 1];
        const endsWithFrame = this.#next > begin && last.sample.time_s === time_s;
        const end = endsWithFrame ? this.#next : this.#next + 1;
        const samples = this.#samples.slice(begin, end).map(({ sample }) => ({ ...sample, time_s: sample.time_s + this.#begin_s }));
        return { samples, commands: { calibrate: last?.calibrate ?? false } };
    }
}
