#!/usr/bin/env python3
"""A driver for `kirk run MISSION --driver stdio:examples/drivers/robot.py`.

It starts an activity for each dispatch, confirms that, and reports the end when the activity is over. Here every activity
takes ROBOT_SECONDS (half a second if not set); a real driver talks to a robot instead.

A dispatch may come more than once: kirk repeats it when no confirmation has reached it, also after a restart of kirk. The
id says that it is the same one. What has been started is kept in the file ROBOT_STATE, if that is set, so that it is known
after a restart of this program too.
"""

import json
import os
import sys
import threading
import time

SECONDS = float(os.environ.get("ROBOT_SECONDS", "0.5"))
STATE = os.environ.get("ROBOT_STATE")
started = {}
lock = threading.Lock()


def say(message):
    with lock:
        print(json.dumps(message), flush=True)


def start(id, companion, at):
    """Starts an activity; its end is reported when it is over."""
    wait = max(0.0, at + SECONDS - time.time())
    timer = threading.Timer(wait, lambda: say({"observed": {"event": companion}}))
    timer.daemon = True
    timer.start()


def dispatch(id, companion):
    known = id in started
    if not known:
        started[id] = time.time()
        if STATE:
            with open(STATE, "a") as state:
                state.write(json.dumps([id, companion, started[id]]) + "\n")
    # If it was started before, say how long ago that was.
    say({"executed": {"id": id, "ago": time.time() - started[id]}})
    if companion and not known:
        start(id, companion, started[id])


if STATE and os.path.exists(STATE):
    with open(STATE) as state:
        for line in state:
            id, companion, at = json.loads(line)
            started[id] = at
            if companion:
                start(id, companion, at)

for line in sys.stdin:
    message = json.loads(line)
    if "dispatch" in message:
        dispatch(message["dispatch"]["id"], message["dispatch"]["companion"])
    elif "over" in message:
        print("the mission is over:", message["over"]["outcome"], file=sys.stderr)
