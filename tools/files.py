"""Files as the program itself treats them: outputs that get their names only when they are whole, and pipes."""
import contextlib
import os
import pathlib
import select
import signal
import stat
import tempfile
import time

PATIENCE = 5  # seconds


def read_text(path):
    """All of a file, or of a named pipe, if a program opens that for writing within a few seconds."""
    if not stat.S_ISFIFO(os.stat(path).st_mode):
        return pathlib.Path(path).read_text("utf-8")
    number, deadline, pieces, written = os.open(path, os.O_RDONLY | os.O_NONBLOCK), time.monotonic() + PATIENCE, [], False
    with open(number, "rb", buffering=0) as pipe:
        while True:
            piece = pipe.read(1 << 16)
            if piece is None:  # a writer that has written nothing yet
                written = True
                select.select([pipe], [], [])
            elif piece:
                pieces.append(piece)
            elif pieces or written:
                return b"".join(pieces).decode("utf-8")
            elif time.monotonic() > deadline:
                raise OSError(f"{path}: expected a program that writes to this named pipe, found none within {PATIENCE} s")
            else:
                time.sleep(0.02)


@contextlib.contextmanager
def whole_file(path):
    """A binary file to write to, of this run alone: it gets the name `path` where the block ends well, and is removed
    where it does not, also by Ctrl-C and kill. What is no ordinary file (a device, a pipe) is written to directly."""
    path = pathlib.Path(os.path.realpath(path))  # a link stays one: the file that it leads to is replaced
    if path.exists() and not path.is_file():
        with open(path, "wb") as file:
            yield file
        return
    mode = path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~_umask()
    number, partial = tempfile.mkstemp(prefix=f"{path.name[:200]}.", suffix=".partial", dir=path.parent)
    previous = signal.signal(signal.SIGTERM, _end)
    try:
        with open(number, "wb") as file:
            yield file
            file.flush()
            os.fchmod(file.fileno(), mode)
            os.fsync(file.fileno())
        os.replace(partial, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise
    finally:
        signal.signal(signal.SIGTERM, previous)


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _end(number, _):
    raise SystemExit(128 + number)
