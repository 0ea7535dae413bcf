#!/usr/bin/env python3
"""Types every command of the documentation, as a reader does: commands_test.py FOLDER

A command is a line of an indented block or of a fence without a language, and a code span that is a whole command. A
block with other than ASCII outside of its comments is a drawing or a formula. The commands of a page run in order, in
one shell, in a folder that has what readers bring (stand_ins), and shortened (SHORTER). What cannot run here is in
not_run.txt, below its reason. FOLDER is made anew. ctest sets SOURCE, BUILD, and LEFT_OUT, a reason to skip, or nothing.
"""
import functools
import http.server
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import threading

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
HISTORY = ("CHANGELOG.md", "NOTES.md")  # what changed, and what was measured once
NOT_OURS = re.compile(r"(^|/)(build|\.\w+)/")

# What a page writes for something of the reader's. FOLDER, DIR and OTHER are names as they are.
PLACEHOLDERS = {"IN...": "scene.ply", "FILE": "scene.voy", "SCENE": "scene.voy", "OUT": "out.ply", "N": "10000",
                "MB": "500", "COMMAND": "bake"}
# Less of the same work; no window that waits for somebody to close it; tests are looked for, as ctest runs them anyway.
SHORTER = [(r"--gaussians \d+", "--gaussians 10000"), (r"--frames \d+", "--frames 2"),
           (r"--optimize \d+", "--optimize 0.01"),
           (r"^(voyager view.*)", r"\1 --frames 2"),
           (r"^(openxr_headset (?!.*--frames).*)", r"\1 --frames 2"),
           (r"^(vulkan_host (?!.*--offscreen).*)",
            r"\1 --offscreen --camera-file city.cameras.json --frames 2 -o window"),
           (r"^ctest (--preset|--test-dir) \S+(.*)", rf"ctest --test-dir {BUILD}\2"),
           (r"^ctest .*", r"\g<0> -N | grep 'Tests: [1-9]'"),
           (r"^\w+_tests .*", r"\g<0> --gtest_list_tests")]
# A code span is a command if it begins with one of these and goes on. `voyager bake` is a name.
PROGRAM = (r"voyager \S+|cmake \S+|npm \S+|ctest|ninja|git|sudo|apt-get|openxr_headset|vulkan_host"
           r"|(scripts|bench|build)/\S+|[A-Z_]+=\S+")
CHANGES_THE_MACHINE = ("sudo ", "apt-get ", "npm ")


def commands_of_block(block):
    """(line number, command) of each; a line may go on after a backslash, or hold several between &&."""
    lines = [(number, re.sub(r"(^|\s+)#.*", "", text).strip()) for number, text in block]
    if not all(text.isascii() for _, text in lines):
        return
    begun = ""
    for number, text in lines:
        if text.endswith("\\"):
            begun += text[:-1]
            continue
        yield from ((number, command) for command in (begun + text).split(" && ") if command)
        begun = ""


def read_page(path):
    """[(line number, command)] in order, and the files that the page shows, as {name: text}."""
    commands, files, block, language = [], {}, [], None
    for number, line in enumerate(path.read_text().splitlines() + [""], 1):
        fence = re.match(r" *```(\w*)", line)
        if fence is None and (language is not None or line.startswith("    ")):
            block.append((number, line))
            continue
        if language in (None, "", "sh"):
            commands += commands_of_block(block)
        elif language in ("c", "cmake"):
            files["main.c" if language == "c" else "CMakeLists.txt"] = "\n".join(text for _, text in block)
        block = []
        if fence is not None:
            language = fence.group(1) if language is None else None
            continue
        for span in re.findall("`([^`]+)`", line):
            if re.match(rf"({PROGRAM}) \S", span):
                commands += [(number, command) for command in span.split(" && ")]
    return commands, files


def read_not_run():
    """The commands."""
    lines = (SOURCE / "tests/docs/not_run.txt").read_text().splitlines()
    return {line.strip() for line in lines if line.startswith("    ")}


class RangeServer(http.server.SimpleHTTPRequestHandler):
    """http://host/ of the pages: what Voyager asks of any server, which Python's own does not have."""

    def do_GET(self):
        try:
            content = pathlib.Path(self.translate_path(self.path)).read_bytes()
        except OSError:
            self.send_error(404)
            return
        asked = re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers.get("Range", ""))
        first, last = (int(asked[1]), min(int(asked[2]), len(content) - 1)) if asked else (0, len(content) - 1)
        self.send_response(206 if asked else 200)
        self.send_header("ETag", '"1"')
        self.send_header("Content-Length", str(last + 1 - first))
        if asked:
            self.send_header("Content-Range", f"bytes {first}-{last}/{len(content)}")
        self.end_headers()
        self.wfile.write(content[first:last + 1])

    def log_message(self, *_):
        pass


def serve(folder):
    """Serves the folder's files until this process ends, and returns the address."""
    server = http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), functools.partial(RangeServer, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"127.0.0.1:{server.server_port}"


def as_typed(command):
    command = re.sub(r"\[(--[^]]*|[A-Z]+)\]", r"\1", command)  # what may be left out is typed, too
    command = command.replace("VOYAGER/", f"{SOURCE}/").removeprefix("build/release/bin/")
    command = " ".join(PLACEHOLDERS.get(word, word) for word in command.split())
    for pattern, shorter in SHORTER:
        command = re.sub(pattern, shorter, command)
    return command


def run(script, folder, home):
    """The exit code, and what was said. The commands are those of the build; nothing is displayed."""
    variables = {name: value for name, value in os.environ.items()
                 if not re.match("CMAKE_|XR_|LD_LIBRARY_PATH|DISPLAY|WAYLAND_DISPLAY", name)}
    variables |= {"HOME": str(home), "PATH": f"{BUILD}/bin:{os.environ['PATH']}", "CMAKE_GENERATOR": "Ninja",
                  "PKG_CONFIG_PATH": f"{home}/voyager/lib/pkgconfig",
                  "XR_RUNTIME_JSON": f"{BUILD}/lib/voyager_test_runtime.json"}  # no headset
    done = subprocess.run(["bash", "-c", f"set -eo pipefail\n{script}"], cwd=folder, env=variables, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def stand_ins(folder, home):
    """What readers bring: scenes of 600 Gaussians, two small cameras, a host, the build, the library in ~/voyager."""
    folder.mkdir(parents=True)
    home.mkdir()
    code, said = run(f"""
        voyager synth city --gaussians 10000 --sh-degree 1 -o large.ply
        voyager bake large.ply -o large.voy
        voyager export large.voy -o city.ply --keep 600
        voyager bake city.ply -o city.voy
        voyager convert city.ply -o hall.glb
        voyager export city.voy -o scene.hier
        mkdir -p FOLDER tiles build/release
        for copy in scene.ply garden.ply tiles/0.ply tiles/1.ply; do cp city.ply $copy; done
        for copy in scene.voy a.voy b.voy; do cp city.voy $copy; done
        cp scene.hier x.hier
        cp {SOURCE}/tests/package/consumer/frame.c host.c
        mkdir scripts plugin tests
        cp {SOURCE}/scripts/check_abi.sh scripts
        cp -r {SOURCE}/plugin/include plugin
        cp -r {SOURCE}/tests/abi tests
        ln -s {BUILD}/bin {BUILD}/lib build/release
        ln -s {BUILD} build/library
        cmake --install {BUILD} --prefix ~/voyager""", folder, home)
    if code != 0:
        sys.exit(said)
    cameras = json.loads((folder / "large.cameras.json").read_text())[:2]
    for camera in cameras:
        shrink = camera["width"] / 96
        camera.update({name: type(camera[name])(camera[name] / shrink)
                       for name in ("width", "height", "fx", "fy", "cx", "cy") if name in camera})
    for name in ("city.cameras.json", "cameras.json", "cams.json", "FOLDER/cameras.json"):
        (folder / name).write_text(json.dumps(cameras))


def fault_of(name, commands, files, work, host):
    """The command that failed and what it said, "" where none did."""
    place = work / name.replace("/", "_")
    shutil.copytree(work / "stand_ins", place, symlinks=True)
    for file, text in files.items():
        (place / file).write_text(text)
    script = []
    for number, command in commands:
        if command.startswith(CHANGES_THE_MACHINE):
            return f"{name}:{number}: {command}\nexpected it in not_run.txt, because it changes the machine\n"
        typed = as_typed(command).replace("http://host/", f"http://{host}/")
        script += ["echo " + shlex.quote(f"@@ {name}:{number}: {typed}"), typed]
    code, said = run("\n".join(script), place, work / "home")
    return "" if code == 0 else f"{said.rpartition('@@ ')[2]}exit code {code}\n"


def main():
    if os.environ.get("LEFT_OUT"):
        print(os.environ["LEFT_OUT"])
        return 77
    work = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(work, ignore_errors=True)
    stand_ins(work / "stand_ins", work / "home")
    _, said = run("voyager view city.voy --frames 1", work / "stand_ins", work / "home")
    if "found no Vulkan" in said and not os.environ.get("VOYAGER_REQUIRE_VULKAN"):
        print(said.strip().splitlines()[-1])
        return 77
    host = serve(work / "stand_ins")
    not_run = read_not_run()
    faults, typed, met = [], 0, set()
    for path in sorted(SOURCE.rglob("*.md")):
        name = str(path.relative_to(SOURCE))
        if path.name in HISTORY or NOT_OURS.search(name):
            continue
        commands, files = read_page(path)
        met |= {command for _, command in commands} & not_run
        commands = [(number, command) for number, command in commands if command not in not_run]
        if commands:
            faults.append(fault_of(name, commands, files, work, host))
            typed += len(commands)
    faults += [f"not_run.txt: {command}: found on no page\n" for command in sorted(not_run - met)]
    faults = list(filter(None, faults))
    print("\n".join(faults), end="")
    print(f"{typed} commands were typed, {len(met)} are in not_run.txt, {len(faults)} failed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
