#!/usr/bin/env python3
"""A link between a client and a server: so much bandwidth, and so long a way there and back.

    slow_link.py PORT SERVER_PORT MBIT ROUND_TRIP_MS

Connections share the bandwidth of what comes from the server. To make a connection takes a
round trip, as with TCP, and the first byte of an answer another. For measurements where the
kernel has no netem (bench/NOTES.md, "Scenes from a server").
"""
import asyncio
import sys

PORT, SERVER = int(sys.argv[1]), int(sys.argv[2])
MBIT, ROUND_TRIP = float(sys.argv[3]), float(sys.argv[4]) / 1e3
BYTES_A_SECOND = MBIT * 1e6 / 8
PIECE = 16384
free_at = 0.0  # when the link has sent all that came before


async def pump(reader, writer, delay, rated):
    """Each piece is passed on after its delay, while more is read behind it."""
    loop = asyncio.get_running_loop()
    queue = asyncio.Queue(4096)

    async def read():
        global free_at
        try:
            while data := await reader.read(PIECE):
                due = loop.time()
                if rated:
                    free_at = max(free_at, due) + len(data) / BYTES_A_SECOND
                    due = free_at
                    await asyncio.sleep(max(0, due - loop.time() - 0.05))  # 50 ms ahead at most
                await queue.put((due + delay, data))
        except ConnectionError:
            pass
        finally:
            await queue.put((0, None))

    task = asyncio.create_task(read())
    try:
        while True:
            due, data = await queue.get()
            if data is None:
                break
            await asyncio.sleep(max(0, due - loop.time()))
            writer.write(data)
            await writer.drain()
    except (ConnectionError, asyncio.CancelledError):
        pass
    finally:
        task.cancel()
        writer.close()


async def serve(client_reader, client_writer):
    await asyncio.sleep(ROUND_TRIP)
    try:
        server_reader, server_writer = await asyncio.open_connection("127.0.0.1", SERVER)
    except OSError:
        client_writer.close()
        return
    await asyncio.gather(
        pump(client_reader, server_writer, ROUND_TRIP / 2, False),
        pump(server_reader, client_writer, ROUND_TRIP / 2, True),
        return_exceptions=True,
    )


async def main():
    server = await asyncio.start_server(serve, "127.0.0.1", PORT)
    async with server:
        await server.serve_forever()


asyncio.run(main())
