"""A TCP proxy on the loopback interface that delays what passes, as a network would: a constant delay, jitter, and pauses where a packet
would be lost and sent again. TCP keeps the order, so all later bytes wait too.

usage: delay_proxy.py SERVER_PORT [--delay-ms 75] [--jitter-ms 20] [--loss 0.02] [--seed 1]      prints its own port
"""
import argparse
import asyncio
import random


class DelayProxy:
    """Each direction has its own delays, from one seed. A lost packet comes a round trip and a timeout of 200 ms at most later."""

    def __init__(self, server_port: int, delay_s: float, jitter_s: float, loss: float, seed: int = 1):
        self.server_port, self.delay_s, self.jitter_s, self.loss = server_port, delay_s, jitter_s, loss
        self.random = random.Random(seed)
        self.pieces = 0
        self.lost = 0

    async def start(self) -> int:
        self.server = await asyncio.start_server(self.accept, "127.0.0.1", 0)
        return self.server.sockets[0].getsockname()[1]

    async def accept(self, reader, writer):
        server_reader, server_writer = await asyncio.open_connection("127.0.0.1", self.server_port)
        await asyncio.gather(self.carry(reader, server_writer), self.carry(server_reader, writer), return_exceptions=True)

    async def carry(self, reader, writer):
        queue: asyncio.Queue = asyncio.Queue(maxsize=4096)
        pump = asyncio.create_task(self.deliver(queue, writer))
        loop = asyncio.get_running_loop()
        due = 0.0
        try:
            while data := await reader.read(1400):
                wait_s = self.delay_s + self.random.uniform(0.0, self.jitter_s)
                if self.random.random() < self.loss:
                    wait_s += min(2.0 * self.delay_s + 0.02, 0.2)
                    self.lost += 1
                self.pieces += 1
                due = max(due, loop.time() + wait_s)
                await queue.put((due, data))
        except ConnectionError:
            pass
        await queue.put((due, b""))
        await pump

    async def deliver(self, queue, writer):
        loop = asyncio.get_running_loop()
        try:
            while True:
                due, data = await queue.get()
                await asyncio.sleep(max(0.0, due - loop.time()))
                if not data:
                    break
                writer.write(data)
                await writer.drain()
        except ConnectionError:
            pass
        writer.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("server_port", type=int)
    parser.add_argument("--delay-ms", type=float, default=75.0, help="one way")
    parser.add_argument("--jitter-ms", type=float, default=20.0)
    parser.add_argument("--loss", type=float, default=0.02)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()

    async def run():
        proxy = DelayProxy(options.server_port, options.delay_ms / 1e3, options.jitter_ms / 1e3, options.loss, options.seed)
        print(await proxy.start(), flush=True)
        await proxy.server.serve_forever()

    try:
        asyncio.run(run())
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
