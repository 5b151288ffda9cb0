#!/bin/sh
# A driver for `kirk run MISSION --driver stdio:examples/drivers/robot.sh`, for a shell and nothing else.
#
# It confirms every dispatch and reports the end of each activity after ROBOT_SECONDS (half a second if not set). A dispatch
# that was seen before, by its id, is confirmed and not started again.

field() { printf '%s\n' "$line" | sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p"; }

seen=' '
while read -r line; do
    case $line in
    '{"dispatch"'*)
        id=$(field id)
        companion=$(field companion)
        case $seen in
        *" $id "*) ;;
        *)
            seen="$seen$id "
            if [ -n "$companion" ]; then
                (
                    sleep "${ROBOT_SECONDS:-0.5}"
                    printf '{"observed": {"event": "%s"}}\n' "$companion"
                ) &
            fi
            ;;
        esac
        printf '{"executed": {"id": "%s"}}\n' "$id"
        ;;
    '{"over"'*) exit 0 ;;
    esac
done
