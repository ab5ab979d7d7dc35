#!/usr/bin/env bash
# vitrum and POV-Ray on the same picture, in turns: benches/peers/povray/compare.sh [WIDTHxHEIGHT [SIDE [DEPTH [PAIRS]]]]
#
#   WIDTHxHEIGHT  the picture, 640x480
#   SIDE          samples per pixel along one side, 4: SIDE * SIDE samples for each pixel
#   DEPTH         vitrum's max_depth, 10
#   PAIRS         timed pairs, 5; at least 5
#
# VITRUM names the program; unset, it is built (release). Prints for each pair the wall seconds of both programs, the
# seconds that POV-Ray says it traced for, and two ratios: of the wall seconds, and of POV-Ray's tracing alone to all of
# vitrum. Then their geometric means and ranges, and the difference of the two pictures. README.md explains the settings.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)

size=${1:-640x480} side=${2:-4} depth=${3:-10} pairs=${4:-5}
for number in "${size%x*}" "${size#*x}" "$side" "$depth" "$pairs"; do
    if [[ ! $number =~ ^[0-9]+$ ]]; then
        echo "'$number' is not a whole number; expected $0 [WIDTHxHEIGHT [SIDE [DEPTH [PAIRS]]]]" >&2
        exit 2
    fi
done
if ((side < 1 || pairs < 5)); then
    echo "SIDE is $side and PAIRS is $pairs; expected at least 1 and at least 5" >&2
    exit 2
fi
width=${size%x*} height=${size#*x}
if ! command -v povray >/dev/null; then
    echo "povray is missing: apt-get install povray (3.7)" >&2
    exit 1
fi
if [[ -z ${VITRUM:-} ]]; then
    (cd "$root" && cargo build --release --locked --bin vitrum)
    VITRUM=${CARGO_TARGET_DIR:-$root/target}/release/vitrum
fi

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# vitrum: the whole program, its picture written.
ours() {
    "$VITRUM" render "$here/three_spheres.toml" --size "$size" --spp $((side * side)) --max-depth "$depth" \
        --threads 2 --quiet -o "$scratch/vitrum.png"
}

# POV-Ray: as many pixels as there are samples, none of them supersampled. ARGUMENTS say what to write.
theirs() {
    if ! povray +I"$here/three_spheres.pov" +W$((width * side)) +H$((height * side)) -A -D +WT2 -MB \
        Declare=MaxDepth="$depth" "$@" >"$scratch/povray.log" 2>&1; then
        cat "$scratch/povray.log" >&2
        return 1
    fi
}

# seconds COMMAND...: runs it and sets `took` to its wall seconds.
seconds() {
    local start=$EPOCHREALTIME
    "$@"
    took=$(awk -v start="$start" -v end="$EPOCHREALTIME" 'BEGIN { printf "%.3f", end - start }')
}

# One pair that is not timed: it warms the caches and gives the pictures. Linear, 16 bits per channel.
ours
theirs +O"$scratch/povray.ppm" +FP16 File_Gamma=1
samples=$(awk '$1 == "Pixels:" { print $2 }' "$scratch/povray.log")
if ((samples != width * height * side * side)); then
    echo "POV-Ray traced $samples samples; expected $((width * height * side * side))" >&2
    exit 1
fi
echo "$size, $((side * side)) samples per pixel ($samples in all), max_depth $depth, 2 threads"
povray --version 2>&1 | sed -n '/^POV-Ray/p'
grep -m1 'Max Level' "$scratch/povray.log"

printf '%4s %10s %10s %10s %8s %8s\n' pair vitrum povray tracing ratio strict
for ((pair = 1; pair <= pairs; pair++)); do
    # Who goes first changes from pair to pair, so that a drift of the machine's speed cancels.
    if ((pair % 2)); then
        seconds ours
        our_time=$took
        seconds theirs -F
        their_time=$took
    else
        seconds theirs -F
        their_time=$took
        seconds ours
        our_time=$took
    fi
    tracing=$(sed -n 's/.*Trace Time:.*(\([0-9.]*\) seconds).*/\1/p' "$scratch/povray.log")
    awk -v pair="$pair" -v ours="$our_time" -v theirs="$their_time" -v tracing="$tracing" \
        'BEGIN { printf "%4d %9.3fs %9.3fs %9.3fs %8.2f %8.2f\n", pair, ours, theirs, tracing, theirs / ours, tracing / ours }' |
        tee -a "$scratch/pairs"
done

# summary COLUMN WHAT: geometric mean and range of a column of ratios.
summary() {
    awk -v column="$1" -v what="$2" '
        { r = $column; sum += log(r); if (NR == 1 || r < least) least = r; if (NR == 1 || r > most) most = r }
        END { printf "%s: %.2f (geometric mean of %d pairs, %.2f to %.2f)\n", what, exp(sum / NR), NR, least, most }' \
        "$scratch/pairs"
}
summary 5 "povray / vitrum, wall seconds"
summary 6 "povray tracing / all of vitrum"

python3 "$here/difference.py" "$scratch/vitrum.png" "$scratch/povray.ppm"
