"""raycache for Python. raycache.traces reads traces, independently of the program; it needs numpy, zstandard, xxhash.

    from raycache.traces import Trace
    for launch, warp, records in Trace("mj.rct").warps():
        print(launch, warp, len(records))
"""
