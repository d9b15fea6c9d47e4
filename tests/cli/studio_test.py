"""The studio's server as a browser and an attacker see it: calls, files, events, and what it refuses. The page itself: tests/browser."""

import array
import html
import http.client
import json
import math
import os
import pathlib
import re
import shlex
import signal
import socket
import subprocess
import threading
import time
import unittest

import small_case
import small_photo
from command import BAD_CASE, BAD_DATA, COMMAND, DONE, CommandTest

LONG_CUT = {"cut": {"advance_per_step_mm": 0.2}}  # long enough to be met on its way


class Studio:
    """A studio that runs: its own page's way of asking, and the parts to ask otherwise."""

    def __init__(self, folder, *arguments):
        self.process = subprocess.Popen([COMMAND, "studio", *arguments], cwd=folder, stdout=subprocess.PIPE, text=True)
        address = re.search(r"http://127\.0\.0\.1:(\d+)/#token=(\w+)", self.process.stdout.readline())
        self.port, self.token = int(address[1]), address[2]

    def stop(self, with_signal=signal.SIGTERM):
        self.process.send_signal(with_signal)
        self.process.wait()
        self.process.stdout.close()
        return self.process.returncode

    def ask(self, method, target, body=None, **headers):
        """Status, header fields and body. A header given as None is left out."""
        fields = {"Host": f"127.0.0.1:{self.port}", "X-Incise-Token": self.token, "Content-Type": "application/json"}
        fields.update({name.replace("_", "-"): value for name, value in headers.items()})
        connection = http.client.HTTPConnection("127.0.0.1", self.port)
        try:
            connection.putrequest(method, target, skip_host=True, skip_accept_encoding=True)
            for name, value in fields.items():
                if value is not None:
                    connection.putheader(name, value)
            if body is not None:
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def call(self, name, arguments=None):
        status, _, body = self.ask("POST", f"/api/call/{name}", json.dumps(arguments or {}).encode())
        return status, json.loads(body)

    def array(self, named):
        status, _, body = self.ask("GET", f"/api/blob/{named['blob']}")
        assert status == 200, body
        values = array.array({"int16": "h", "uint8": "B", "uint32": "I", "float32": "f"}[named["type"]])
        values.frombytes(body)
        assert len(values) == named["count"]
        return values


def children_of(pid):
    return [int(word) for word in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


class StudioTest(CommandTest):
    def studio(self, *arguments, folder=None):
        studio = Studio(folder or self.folder, *arguments)
        self.addCleanup(lambda: studio.process.poll() is None and studio.stop(signal.SIGKILL))
        return studio

    def small(self, changes=None):
        return small_case.write_case(self.folder / "case", changes or {})


class Calls(StudioTest):
    def test_goes_from_a_scan_to_tissue_an_edge_and_a_path_and_the_command_goes_on_from_there(self):
        studio = self.studio()
        here = studio.call("files")[1]
        status, case = studio.call("demo", {"folder": here["folder"]["id"], "seed": 3})
        self.assertEqual((status, case["is_virtual"]), (200, True))
        scan = studio.call("scan")[1]
        voxels = studio.array(scan["voxels"])
        self.assertEqual(len(voxels), scan["grid"]["size"][0] * scan["grid"]["size"][1] * scan["grid"]["size"][2])
        self.assertEqual((min(voxels), max(voxels)), (scan["least_hu"], scan["greatest_hu"]))
        tissue = studio.call("tissue")[1]
        self.assertEqual(sum(studio.array(tissue["labels"])), tissue["summary"]["voxels"])
        vertices, triangles = studio.array(tissue["skin"]["vertices"]), studio.array(tissue["skin"]["triangles"])
        self.assertLess(max(triangles), len(vertices) // 3)
        inner = next(entry for entry in studio.call("files")[1]["entries"] if entry["kind"] == "case")
        scans = [entry for entry in studio.call("files", {"folder": inner["id"]})[1]["entries"] if entry["kind"] == "scan"]
        status, made = studio.call("create", {"scan": scans[0]["id"], "folder": here["folder"]["id"], "name": "drawn", "settings": {"ct.window_hu": [-20, 180]}})
        self.assertEqual(status, 200, made)
        top = max(range(0, len(vertices), 3), key=lambda at: vertices[at + 2])
        x, y, z = vertices[top : top + 3]
        square = [[x - 4, y - 4, z], [x + 4, y - 4, z], [x + 4, y + 4, z], [x - 4, y + 4, z]]
        status, drawn = studio.call("edge", {"revision": made["revision"], "points_mm": square, "configuration": "rest"})
        self.assertEqual((status, drawn["inputs"]["tumor.contour"]), (200, "tumor_edge.csv"), drawn)
        self.assertEqual((drawn["edge"]["configuration"], drawn["edge"]["points_mm"][0]), ("rest", square[0]))
        self.assertEqual((drawn["choices"]["tumor.configuration"], drawn["units"]["plan.depth_mm"]), (["stretched", "rest"], "mm"))
        room = studio.call("room", {"points_mm": square})[1]
        self.assertEqual((room["fits"], room["painted"], room["edge_on_cut_face"], room["problem"]), (True, 0, 0, None))
        self.assertIn(f"{room['greatest_margin_mm']:g} mm fits here", room["margin_note"])
        stroke = {"tissue": False, "radius_mm": 50, "path_mm": [[x, y, z + 47]]}  # it takes 3 mm of the top away
        status, edited = studio.call("change", {"revision": drawn["revision"], "set": {"ct.edits": [stroke]}})
        self.assertEqual(status, 200, edited)
        self.assertGreater(studio.call("room", {"points_mm": square})[1]["painted"], 20)
        self.assertIn(2, studio.array(studio.call("tissue")[1]["cut"]))
        status, drawn = studio.call("change", {"revision": edited["revision"], "set": {"ct.edits": None}})
        status, changed = studio.call("change", {"revision": drawn["revision"], "set": {"meshing.tets": 6000, "plan.depth_mm": 4}})
        self.assertEqual((status, changed["settings"]["plan"]["depth_mm"]), (200, 4.0))
        body = studio.call("body")[1]
        self.assertEqual(body["constraints"][1]["setting"]["displacement_mm"], [0, -20, 0])
        held = studio.array(body["held"])
        self.assertEqual([constraint["kind"] for constraint in body["constraints"]], ["fixed", "displaced", "support"])
        self.assertTrue(any(mark & 1 for mark in held) and any(mark & 2 for mark in held) and 0 in held)
        settings = [constraint["setting"] for constraint in body["constraints"]]  # the default, written out, holds as the default does
        status, changed = studio.call("change", {"revision": changed["revision"], "set": {"specimen.constraints": settings}})
        self.assertEqual(status, 200, changed)
        self.assertEqual([constraint["vertices"] for constraint in studio.call("body")[1]["constraints"]], [constraint["vertices"] for constraint in body["constraints"]])
        stretched = studio.call("stretch")[1]
        self.assertEqual(stretched["outcome"], "success")
        self.assertEqual(len(studio.array(stretched["skin"]["vertices"])), len(studio.array(stretched["rest"])))
        plan = studio.call("plan")[1]
        self.assertEqual({round(depth, 9) for depth in plan["path"]["depth_mm"]}, {4.0})
        self.assertEqual(studio.stop(), DONE)
        again = self.json_of("plan", self.folder / "drawn")
        self.assertEqual({stage["state"] for stage in again["stages"]} - {"reused", "skipped"}, set())

    def test_runs_a_case_shows_the_cut_and_gives_what_the_command_gives(self):
        case = self.small()
        studio = self.studio(case)
        events = []
        follower = threading.Thread(target=self.follow, args=(studio, events), daemon=True)
        follower.start()
        status, run = studio.call("run")
        self.assertEqual((status, run["verdict"]["status"], run["program"]), (200, "refused", None), run)
        self.assertIsNotNone(run["as_planned"]["errors"]["signed_mm"])
        self.assertEqual(studio.call("run", {"accept": ["nothing"]})[0], 422)
        studio.stop()
        follower.join()
        kinds = {event for event, _ in events}
        self.assertLessEqual({"state", "progress", "message", "moment"}, kinds)
        moment = next(content for event, content in events if event == "moment")
        self.assertEqual((moment["cut"], len(moment["tip"])), ("as_planned", 3))
        other = self.folder / "other"
        self.incise("run", case, "-o", other)
        by_command = json.loads((other / "study.json").read_text())
        self.assertEqual(run["verdict"], by_command["verdict"])
        self.assertEqual(run["as_planned"]["numbers"]["mean_error_mm"], by_command["before"]["abs_error_mm"]["mean"])
        too_near = [reason["value"] for reason in by_command["before"]["verdict"]["reasons"] if reason["id"] == "lateral_margin"]
        self.assertEqual([run["as_planned"]["numbers"]["nearest_to_tumor_mm"]], too_near)
        page = (other / "report.html").read_text()
        for key, name in (("nearest_to_tumor_mm", "Closest approach to the tumour"), ("least_depth_mm", "Least depth"), ("greatest_error_mm", "Greatest error")):
            row = page.split(f'<th scope="row">{name}</th>')[1].split("</tr>")[0]
            self.assertIn(f">{run['as_planned']['numbers'][key]:.2f} mm</td>".replace("-", "−"), row, name)
        findings = html.unescape(page.split('id="findings"')[1].split("</section>")[0])
        for reason in by_command["verdict"]["reasons"]:
            self.assertIn(reason["message"], findings)

    @staticmethod
    def follow(studio, events):
        connection = http.client.HTTPConnection("127.0.0.1", studio.port)
        connection.request("GET", "/api/events", headers={"X-Incise-Token": studio.token})
        kind = None
        try:
            for line in connection.getresponse():
                name, _, value = line.decode().rstrip("\n").partition(": ")
                if name == "event":
                    kind = value
                elif name == "data":
                    events.append((kind, json.loads(value)))
        except (ConnectionError, http.client.HTTPException):
            pass
        finally:
            connection.close()

    def cutting(self, studio):
        """A run that has come to its cut: the thread that asked for it, and the list that its answer will be in."""
        answers = []
        asking = threading.Thread(target=lambda: answers.append(studio.call("run")))
        asking.start()
        self.wait_until(lambda: any(one["stage"].startswith("cut") for one in studio.call("state")[1]["running"]))
        return asking, answers

    def test_a_change_during_a_run_is_no_part_of_its_result(self):
        studio = self.studio(self.small(LONG_CUT))
        asking, answers = self.cutting(studio)
        status, _ = studio.call("change", {"revision": studio.call("case")[1]["revision"], "set": {"plan.depth_mm": 4}})
        self.assertEqual(status, 200)
        for other in ("body", "run", "lay"):
            status, refused = studio.call(other)
            self.assertEqual((status, refused["problem"]["message"]), (422, "A run is under way. Wait for its end, or stop it."), other)
        asking.join()
        status, run = answers[0]
        self.assertEqual((status, {round(depth, 9) for depth in run["as_planned"]["depth"]["planned_mm"]}), (200, {5.0}))

    def test_a_run_that_is_stopped_goes_on(self):
        studio = self.studio(self.small(LONG_CUT))
        asking, answers = self.cutting(studio)
        studio.call("stop", {"call": "run"})
        asking.join()
        self.assertEqual(answers[0][0], 499, answers)
        self.assertTrue(list((self.folder / "case" / "out" / "cache").glob("*.checkpoint.bin")))
        self.assertEqual(studio.call("run")[0], 200)

    def test_a_worker_that_is_killed_takes_nothing_with_it(self):
        studio = self.studio(self.small(LONG_CUT))
        asking, answers = self.cutting(studio)
        for worker in children_of(studio.process.pid):
            os.kill(worker, signal.SIGKILL)
        asking.join()
        self.assertEqual(answers[0][0], 500)
        self.assertIn("signal 9", answers[0][1]["message"])
        self.assertEqual(studio.call("state")[1]["case"]["title"], "Test block")

    def test_a_killed_server_takes_its_workers_with_it_and_the_next_one_is_where_it_was(self):
        case = self.small()
        studio = self.studio(case)
        before = studio.call("change", {"revision": studio.call("case")[1]["revision"], "set": {"plan.depth_mm": 4}})[1]
        studio.call("body")
        workers = children_of(studio.process.pid)
        self.assertTrue(workers)
        studio.stop(signal.SIGKILL)
        self.wait_until(lambda: not any(pathlib.Path(f"/proc/{worker}").exists() for worker in workers))
        again = self.studio(case)
        self.assertEqual(again.call("case")[1], before)
        folders = pathlib.Path(os.environ.get("TMPDIR", "/tmp")).glob("incise-studio-*")
        self.assertFalse([folder for folder in folders if f"-{studio.process.pid}-" in folder.name])

    def wait_until(self, holds):
        while not holds():
            time.sleep(0.05)


class AfterTheCut(StudioTest):
    SCALE = 0.06  # mm per pixel

    def named(self, studio, name, folder=None):
        listed = studio.call("files", {"folder": folder} if folder else {})[1]["entries"]
        return next(entry for entry in listed if entry["name"] == name)

    def repeated(self, answer):
        """What the command prints that the answer names as its own."""
        words = shlex.split(answer["command"])
        self.assertEqual(words[0], "incise")
        return self.json_of(*words[1:])

    def test_a_photograph_gets_the_measures_of_the_command_and_says_what_was_drawn_by_hand(self):
        case = self.small()
        rings = ((6.0 / self.SCALE, 4.0, small_photo.GREEN, 0.0), (10.0 / self.SCALE, 4.0, small_photo.RED, 0.0))
        small_photo.ring_photo(self.folder / "cut.png", rings=rings)
        studio = self.studio(case)
        photo = self.named(studio, "cut.png")
        self.assertEqual(photo["kind"], "picture")
        picture = studio.call("picture", {"file": photo["id"]})[1]
        self.assertEqual((picture["width"], picture["height"], len(studio.array(picture["rgb"]))), (500, 500, 3 * 500 * 500))
        status, found = studio.call("photograph", {"file": photo["id"], "scale": {"mm_per_pixel": self.SCALE}})
        self.assertEqual((status, found["by_hand"], found["incision_closed"]), (200, [], True), found)
        self.assertEqual(found["evaluation"]["abs_error_mm"], self.repeated(found)["abs_error_mm"])
        self.assertAlmostEqual(found["evaluation"]["abs_error_mm"]["mean"], 0.5, delta=0.02)
        self.assertEqual(sorted(found["files"]), [f"photograph_cut/{name}" for name in ("evaluation.json", "found.png", "manifest.json")])
        for u, v in found["incision_px"]:
            self.assertAlmostEqual(math.hypot(u - 250, v - 250) * self.SCALE, 10.0, delta=0.1)
        angles = [2 * math.pi * n / 72 for n in range(72)]
        drawn = [[250 + 10.5 / self.SCALE * math.cos(a), 250 - 10.5 / self.SCALE * math.sin(a)] for a in angles]
        status, by_hand = studio.call("photograph", {"file": photo["id"], "scale": {"two_points": [100, 100, 200, 100, 6.0]}, "incision_px": drawn})
        outside = studio.call("photograph", {"file": photo["id"], "scale": {"mm_per_pixel": self.SCALE}, "incision_px": [[-5000, -5000], [-4000, -5000], [-4000, -4000]]})[1]
        self.assertEqual(outside["problem"]["path"], "incision_px")
        self.assertEqual((status, by_hand["by_hand"], by_hand["evaluation"]["by_hand"]), (200, ["incision"], ["incision"]), by_hand)
        self.assertAlmostEqual(by_hand["evaluation"]["abs_error_mm"]["mean"], 0.0, delta=0.03)
        self.assertEqual(by_hand["evaluation"]["abs_error_mm"], self.repeated(by_hand)["abs_error_mm"])
        for change, path in (({"scale": {}}, "scale"), ({"scale": {"mm_per_pixel": -1}}, "mm_per_pixel"), ({"scale": {"ruler": "tape"}}, "ruler"),
                             ({"scale": {"two_points": [1, 2]}}, "two_points"), ({"incision_px": [[1, 2]]}, "incision_px"), ({"red": "blue"}, "red"),
                             ({"max_gap_mm": -1}, "max_gap_mm")):
            status, answer = studio.call("photograph", {"file": photo["id"], "scale": {"mm_per_pixel": self.SCALE}, **change})
            self.assertEqual((status, answer["problem"]["path"]), (422, path), answer)
        self.assertEqual(len(list(case.glob("photograph_cut*"))), 1)

    def test_a_virtual_cloud_is_registered_and_the_path_laid_on_it_is_labelled_virtual(self):
        self.json_of("phantom", "--seed", 3, "-o", "specimen")
        studio = self.studio(self.folder / "specimen")
        revision = studio.call("case")[1]["revision"]
        self.assertEqual(studio.call("change", {"revision": revision, "set": {"meshing.tets": 6000, "cut.advance_per_step_mm": 0.8, "compensation.method": "paper"}})[0], 200)
        self.assertEqual(studio.call("lay", {})[1]["problem"]["path"], "registration")
        status, cloud = studio.call("virtual_cloud", {"seed": 4})
        self.assertEqual((status, cloud["cloud_is"], cloud["name"]), (200, "virtual", "virtual_cloud.ply"), cloud)
        status, found = studio.call("register", {"file": cloud["file"], "scale": "fixed"})
        self.assertEqual((status, found["is_virtual"], found["registration"]["outcome"]), (200, True, "converged"), found)
        residuals = [abs(r) for r in studio.array(found["sample"]["residuals_mm"]) if r == r]
        self.assertEqual(len(studio.array(found["sample"]["points"])), 3 * len(studio.array(found["sample"]["residuals_mm"])))
        self.assertGreater(len(residuals), 1000)
        self.assertLess(sorted(residuals)[len(residuals) // 2], 0.3)
        status, laid = studio.call("lay", {"camera": None})
        self.assertEqual(status, 200, laid)
        path = json.loads((self.folder / "specimen" / "on_tissue" / "path" / "path.json").read_text())
        self.assertEqual((path["frame"], path["specimen_is"]), ("robot", "virtual"))
        planned = json.loads((self.folder / "specimen" / "out" / "plan" / "path.json").read_text())
        self.assertEqual(path["specimen_id"], planned["specimen_id"])  # so that a program is held to its specimen
        self.assertEqual(laid["program"] is None, bool(laid["gate"]["missing"] or laid["gate"]["refused"]))
        self.assertEqual(len(laid["commands"]), 3 if laid["follows"] == "corrected" else 2)
        self.assertNotIn("not_simulated", laid["gate"]["missing"])  # its cut was simulated, and its verdict is here
        revision = studio.call("case")[1]["revision"]
        accept = {"accept": ["mesh_resolution"], "revision": revision}
        self.assertEqual(studio.call("lay", {**accept, "registration_sha256": "another"})[1]["problem"]["path"], "registration_sha256")
        self.assertEqual(studio.call("lay", {**accept, "registration_sha256": laid["registration_sha256"]})[0], 200)
        self.assertEqual(studio.call("arm", {"of": "nothing"})[1]["problem"]["path"], "of")
        cleaned = self.json_of("surface", "specimen/virtual_cloud.ply", "-o", "specimen/cleaned.ply")
        self.assertGreater(cleaned["points"], 1000)
        same = studio.call("register", {"file": self.named(studio, "cleaned.ply", self.named(studio, "specimen")["id"])["id"]})[1]
        self.assertTrue(same["is_virtual"], same)  # the mark stays with the points
        self.assertFalse((self.folder / "specimen" / "on_tissue").exists())
        self.assertEqual(studio.call("lay")[0], 200)
        status, mark = studio.call("lay", {"kind": "mark"})
        self.assertEqual((status, mark["follows"]), (200, "edge"), mark)
        speeds = {waypoint["speed_mm_s"] for waypoint in json.loads((self.folder / "specimen/mark_on_tissue/path/path.json").read_text())["waypoints"]}
        self.assertEqual(speeds, {2.0})
        self.assertTrue((self.folder / "specimen" / "on_tissue").exists())  # one of each kind
        edge = self.folder / "specimen" / "tumor.csv"
        before = edge.read_text()
        edge.write_text(before + "\n")
        self.assertEqual(studio.call("arm", {"of": "mark"})[1]["problem"]["found"], "none")  # laid from another edge
        self.assertFalse((self.folder / "specimen" / "on_tissue").exists())
        edge.write_text(before)
        self.assertEqual(studio.call("lay", {"kind": "mark"})[0], 200)
        kept = studio.call("change", {"revision": revision, "set": {"plan.close_margin_mm": 4.6}})[1]
        self.assertFalse((self.folder / "specimen" / "mark_on_tissue").exists())
        self.assertEqual(studio.call("register", {"file": cloud["file"], "scale": "fixed"})[0], 200)
        refused = studio.call("lay")[1]
        self.assertIn("lateral_margin", refused["gate"]["refused"])  # whatever was computed after the cut, its verdict stays
        accept = {"accept": ["not_simulated"], "revision": kept["revision"], "registration_sha256": refused["registration_sha256"]}
        self.assertIsNone(studio.call("lay", accept)[1]["program"])
        changed = studio.call("change", {"revision": kept["revision"], "set": {"meshing.tets": 6500}})
        self.assertEqual(changed[0], 200)
        self.assertFalse((self.folder / "specimen" / "on_tissue").exists())  # it was laid for the case as it was
        status, other = studio.call("lay")
        self.assertEqual(status, 422, other)  # another surface than was registered
        self.assertIn("register again", other["problem"]["message"])
        self.assertEqual(studio.call("unregister")[0], 200)
        self.assertEqual(studio.call("lay")[1]["problem"]["path"], "registration")
        cloud = {"file": studio.call("virtual_cloud", {"seed": 5})[1]["file"]}
        self.assertEqual(studio.call("register", {"file": cloud["file"], "scale": [2, 1]})[1]["problem"]["path"], "scale")
        self.assertEqual(studio.call("register", {"file": cloud["file"]})[0], 200)
        self.assertFalse((self.folder / "specimen" / "on_tissue").exists())  # it lay where the last registration put it

    def test_the_arm_and_the_report_are_those_of_the_run(self):
        case = self.small(small_case.SOUND)
        small_case.write_tumor_surface(case / "tumor.stl")
        studio = self.studio(case)
        self.assertEqual(studio.call("arm")[1]["problem"]["path"], "program")
        self.assertEqual(studio.call("report")[1]["problem"]["path"], "report")
        accept = [word for word in small_case.ACCEPTED if word != "--accept"]
        self.assertEqual(studio.call("run", {"accept": accept})[1]["problem"]["path"], "revision")
        self.assertEqual(studio.call("run", {"accept": accept, "revision": "of another case"})[0], 409)
        status, run = studio.call("run", {"accept": accept, "revision": studio.call("case")[1]["revision"]})
        self.assertIsNotNone(run["program"], run)
        arm = studio.call("arm")[1]
        times, ends, phases = (studio.array(arm[name]) for name in ("time_s", "ends", "phase"))
        self.assertEqual((len(ends), len(phases)), (len(times) * len(arm["hulls"]) * 6, len(times)))
        self.assertEqual((arm["outcome"], arm["hulls"][-1]["name"]), ("completed", "needle"))
        tip = studio.array(arm["tip"])
        needle = 6 * (len(arm["hulls"]) - 1)
        for frame in (0, len(times) // 2, len(times) - 1):
            at = frame * len(arm["hulls"]) * 6 + needle
            for axis in range(3):
                self.assertAlmostEqual(ends[at + axis], tip[3 * frame + axis], delta=0.01)
        self.assertIn("cut", {arm["phases"][phase] for phase in phases})
        report = studio.call("report")[1]
        self.assertEqual(bytes(studio.array(report["html"])), (case / "out" / "report.html").read_bytes())


class OtherBeginnings(StudioTest):
    def test_a_case_is_made_of_a_mesh_a_surface_or_labels(self):
        case = self.small()
        self.json_of("phantom", "--seed", 3, "-o", "specimen")
        self.json_of("segment", "specimen/ct", "-o", "tongue.seg.nrrd")
        studio = self.studio()
        here = studio.call("files")[1]["folder"]["id"]
        of_case = next(entry for entry in studio.call("files")[1]["entries"] if entry["name"] == "case")
        mesh = next(entry for entry in studio.call("files", {"folder": of_case["id"]})[1]["entries"] if entry["kind"] == "mesh")
        status, made = studio.call("create", {"mesh": mesh["id"], "folder": here, "name": "of_mesh", "settings": {}})
        self.assertEqual((status, made["inputs"]["specimen.mesh"]), (200, "../case/block.msh"), made)
        self.assertEqual(studio.call("body")[1]["tets"], 12 * 18 * 4 * 6)
        labels = next(entry for entry in studio.call("files")[1]["entries"] if entry["name"] == "tongue.seg.nrrd")
        self.assertEqual(labels["kind"], "labels")
        status, made = studio.call("create", {"labels": labels["id"], "folder": here, "name": "of_labels", "settings": {}})
        self.assertEqual((status, made["inputs"]["ct.labels"]), (200, "../tongue.seg.nrrd"), made)
        tissue = studio.call("tissue")[1]
        self.assertEqual([one["value"] for one in tissue["given_labels"]], [1])
        volume = tissue["summary"]["volume_mm3"]
        x, y, z = studio.array(tissue["skin"]["vertices"])[:3]
        stroke = {"tissue": False, "radius_mm": 6, "path_mm": [[x, y, z]]}
        status, edited = studio.call("change", {"revision": made["revision"], "set": {"ct.edits": [stroke]}})
        self.assertEqual((status, edited["settings"]["ct"]["edits"][0]["radius_mm"]), (200, 6.0), edited)
        self.assertLess(studio.call("tissue")[1]["summary"]["volume_mm3"], volume - 100)
        status, refused = studio.call("change", {"revision": edited["revision"], "set": {"ct.label_values": [9]}})
        self.assertEqual(status, 200)
        self.assertEqual(studio.call("tissue")[1]["problem"]["path"], "labels")
        surface = self.folder / "ball.stl"
        small_case.write_tumor_surface(surface)
        chosen = next(entry for entry in studio.call("files")[1]["entries"] if entry["name"] == "ball.stl")
        status, made = studio.call("create", {"surface": chosen["id"], "folder": here, "name": "of_surface", "settings": {}})
        self.assertEqual((status, made["inputs"]["specimen.mesh"]), (200, "body.vtu"), made)
        self.assertEqual(studio.call("create", {"folder": here, "name": "of_nothing"})[1]["problem"]["path"], "scan")
        self.assertFalse((self.folder / "of_nothing").exists())


class Refusals(StudioTest):
    def test_bad_arguments_get_one_clear_message_and_change_nothing(self):
        case = self.small()
        text = (case / "case.yaml").read_text()
        studio = self.studio(case)
        revision = studio.call("case")[1]["revision"]
        for call, arguments, path in (
            ("change", {"revision": revision, "set": {"plan.depth_mm": -1}}, "plan.depth_mm"),
            ("change", {"revision": revision, "set": {"plan.depht_mm": 1}}, "plan.depht_mm"),
            ("change", {"revision": revision, "set": [1]}, "set"),
            ("change", {"set": {}}, "revision"),
            ("files", {"folder": 7}, "folder"),
            ("demo", {"folder": studio.call("files")[1]["folder"]["id"], "seed": -1.5}, "seed"),
            ("change", {"revision": revision, "set": {"tumor.surface": "/etc/passwd"}}, "set"),
            ("change", {"revision": revision, "set": {"tumor.contour": "../../secret.csv"}}, "set"),
            ("change", {"revision": revision, "files": {"tumor.contour": "../secret.csv"}}, "tumor.contour"),
            ("change", {"revision": revision, "files": ["x"]}, "files"),
            ("edge", {"revision": revision, "points_mm": [[0, 0, 0]], "configuration": "rest"}, "points_mm"),
            ("edge", {"revision": revision, "points_mm": [[0, 0, 0], [1e300, 0, 0], [0, 1, 0]], "configuration": "rest"}, "points_mm"),
            ("edge", {"revision": revision, "points_mm": "x", "configuration": "rest"}, "points_mm"),
            ("edge", {"revision": revision, "points_mm": [[0, 0, 0], [9, 0, 0], [0, 9, 0]], "configuration": "upright"}, "tumor.configuration"),
            ("open", {"file": "/etc/passwd"}, "file"),
            ("open", {"file": 7}, "file"),
            ("demo", {"folder": studio.call("files")[1]["folder"]["id"], "seed": "x"}, "seed"),
            ("create", {"scan": studio.call("files")[1]["folder"]["id"], "folder": studio.call("files")[1]["folder"]["id"], "name": "../x"}, "name"),
            ("files", {"folder": "nowhere"}, "folder"),
            ("scan", {}, "ct.volume"),
            ("undo", {}, "call"),
        ):
            status, answer = studio.call(call, arguments)
            self.assertEqual(status, 422, (call, arguments, answer))
            self.assertEqual(answer["problem"]["path"], path, answer)
            self.assertTrue(answer["problem"]["message"])
        self.assertEqual((case / "case.yaml").read_text(), text)
        self.assertEqual(sorted(entry.name for entry in case.iterdir()), ["block.msh", "case.yaml", "tumor.csv"])

    def test_a_file_is_chosen_by_its_id(self):
        case = self.small()
        (self.folder / "other.csv").write_text((case / "tumor.csv").read_text())
        studio = self.studio(case)
        revision = studio.call("case")[1]["revision"]
        chosen = next(entry["id"] for entry in studio.call("files")[1]["entries"] if entry["name"] == "other.csv")
        status, changed = studio.call("change", {"revision": revision, "files": {"tumor.contour": chosen}})
        self.assertEqual((status, changed["inputs"]["tumor.contour"]), (200, "../other.csv"), changed)

    def test_an_edge_of_somebody_is_never_overwritten(self):
        case = self.small({"tumor": {"contour": "tumor_edge.csv"}})
        (case / "tumor.csv").rename(case / "tumor_edge.csv")
        before = (case / "tumor_edge.csv").read_text()
        (case / "tumor_edge_2.csv").symlink_to(self.folder / "victim.csv")
        studio = self.studio(case)
        square = [[16, 16, 14], [24, 16, 14], [24, 24, 14], [16, 24, 14]]
        status, drawn = studio.call("edge", {"revision": studio.call("case")[1]["revision"], "points_mm": square, "configuration": "rest"})
        self.assertEqual((status, drawn["inputs"]["tumor.contour"]), (200, "tumor_edge_3.csv"), drawn)
        self.assertEqual((case / "tumor_edge.csv").read_text(), before)
        self.assertFalse((self.folder / "victim.csv").exists())

    def test_a_case_that_somebody_else_changed_is_not_overwritten(self):
        case = self.small()
        studio = self.studio(case)
        revision = studio.call("case")[1]["revision"]
        with open(case / "case.yaml", "a") as file:
            file.write("\n")
        text = (case / "case.yaml").read_text()
        self.assertEqual(studio.call("change", {"revision": revision, "set": {"plan.depth_mm": 4}})[0], 409)
        self.assertEqual((case / "case.yaml").read_text(), text)

    def test_a_change_of_one_case_does_not_reach_its_copy(self):
        case = self.small()
        studio = self.studio(case)
        shown = studio.call("case")[1]
        change = {"revision": shown["revision"], "case_file": str(case.parent / "copy" / "case.yaml"), "set": {"plan.depth_mm": 4}}
        text = (case / "case.yaml").read_text()
        self.assertEqual(studio.call("change", change)[0], 409)
        edge = {**change, "points_mm": [[0, 0, 0], [5, 0, 0], [0, 5, 0]], "configuration": "rest"}
        self.assertEqual(studio.call("edge", edge)[0], 409)
        self.assertEqual((case / "case.yaml").read_text(), text)
        self.assertEqual(studio.call("change", {**change, "case_file": shown["file"]})[0], 200)

    def test_the_command_refuses_what_it_cannot_serve(self):
        self.assert_refused(self.incise("studio", "nowhere"), BAD_DATA, "no such file")
        self.assert_refused(self.incise("studio", "--root", "nowhere"), BAD_DATA, "no such folder")
        self.assert_refused(self.incise("studio", "--port", "99999"), BAD_CASE, "--port")
        with socket.create_server(("127.0.0.1", 0)) as taken:
            self.assert_refused(self.incise("studio", "--port", str(taken.getsockname()[1])), BAD_CASE, "a free port")


class Attacks(StudioTest):
    def setUp(self):
        super().setUp()
        (self.folder / "root").mkdir()
        (self.folder / "secret.csv").write_text("x_mm,y_mm,z_mm\n")
        self.running = self.studio(folder=self.folder / "root")

    def test_only_this_machine_the_own_page_and_the_token_get_an_answer(self):
        ask = self.running.ask
        for host in ("evil.example", "127.0.0.1.evil.example", ""):
            self.assertEqual(ask("POST", "/api/call/state", b"{}", Host=host)[0], 403, host)
            self.assertEqual(ask("GET", "/", Host=host)[0], 403, host)
        self.assertEqual(ask("POST", "/api/call/state", b"{}", Host=None)[0], 403)
        with socket.create_connection(("127.0.0.1", self.running.port)) as twice:
            twice.sendall(f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{self.running.port}\r\nHost: evil.example\r\n\r\n".encode())
            self.assertIn(b" 403 ", twice.recv(100))
        for token in (None, "", "0" * 32):
            self.assertEqual(ask("POST", "/api/call/state", b"{}", X_Incise_Token=token)[0], 401)
            self.assertEqual(ask("GET", "/api/events", X_Incise_Token=token)[0], 401)
        self.assertEqual(ask("POST", "/api/call/state", b"{}", Origin="http://evil.example")[0], 403)
        self.assertEqual(ask("POST", "/api/call/state", b"{}", Sec_Fetch_Site="cross-site")[0], 403)
        self.assertEqual(ask("POST", "/api/call/state", b"{}", Content_Type="text/plain")[0], 415)
        self.assertEqual(ask("OPTIONS", "/api/call/state")[0], 405)
        status, fields, _ = ask("GET", "/", X_Incise_Token=None)
        self.assertEqual(status, 200)
        self.assertIn("frame-ancestors 'none'", fields["Content-Security-Policy"])
        self.assertNotIn("unsafe", fields["Content-Security-Policy"])
        self.assertFalse([name for name in fields if name.lower().startswith("access-control")])

    def test_no_target_leads_out_of_the_page(self):
        for target in ("/page/../server.cpp", "/page/%2e%2e/x", "/page//etc/passwd", "/page/", "//", "/etc/passwd", "/api/blob/../../secret.csv",
                       "/api/blob/" + "0" * 32, "/api/blob/", "/api/nothing"):
            self.assertEqual(self.running.ask("GET", target)[0], 404, target)

    def test_links_do_not_lead_out_of_the_roots(self):
        (self.folder / "root" / "out.csv").symlink_to(self.folder / "secret.csv")
        (self.folder / "root" / "up").symlink_to(self.folder)
        self.assertEqual(self.running.call("files")[1]["entries"], [])

    def test_large_requests_are_refused_before_they_are_read(self):
        status, _, _ = self.running.ask("POST", "/api/call/state", None, Content_Length=str(2 << 30))
        self.assertEqual(status, 413)
        status, _, answer = self.running.ask("POST", "/api/call/state", b" " * (5 << 20))
        self.assertEqual((status, json.loads(answer)["message"]), (413, "A request is at most 4 MB."))
        status, _, _ = self.running.ask("GET", "/", X_Filler="x" * 9000)
        self.assertEqual(status, 400)
        self.assertEqual(self.running.call("state")[0], 200)

    def test_no_json_and_no_http_get_one_clear_answer(self):
        deep = b'{"revision": "x", "set": {"title": ' + b"[" * 100000 + b"]" * 100000 + b"}}"
        for body in (b"{", b"[]", b"7", b"\xff\xfe", b'{"a": ' * 5000, deep):
            self.assertEqual(self.running.ask("POST", "/api/call/change", body)[0], 400, body[:20])
        with socket.create_connection(("127.0.0.1", self.running.port)) as connection:
            connection.sendall(b"\x16\x03\x01 no http\r\n\r\n")
            self.assertIn(b"400", connection.recv(100))
        self.assertEqual(self.running.call("state")[0], 200)

    def test_many_connections_that_say_nothing_do_not_end_it(self):
        idle = [socket.create_connection(("127.0.0.1", self.running.port)) for _ in range(100)]
        for connection in idle:
            connection.close()
        for _ in range(200):  # the places of those that were closed are free again soon
            try:
                status = self.running.call("state")[0]
                break
            except (ConnectionError, http.client.HTTPException):
                time.sleep(0.05)
        self.assertEqual(status, 200)

    def test_a_title_is_a_text(self):
        case = small_case.write_case(self.folder / "root" / "case", {"title": "<script>alert(1)</script>\r\n\r\nevent: x"})
        studio = self.studio(case, folder=self.folder / "root")
        self.assertEqual(studio.call("state")[1]["case"]["title"], "<script>alert(1)</script>\r\n\r\nevent: x")


if __name__ == "__main__":
    unittest.main()
