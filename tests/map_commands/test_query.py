# SPDX-License-Identifier: GPL-3.0-or-later
"""vmap query answers the four questions of places in the Cornell box whose answers are plain.

The box is 5.49 high with an open front at z = 2.8. The tall block, 3.30 high, stands left of the middle towards the
back, the lamp hangs under the middle of the ceiling.
"""

import json

import pytest
from conftest import refuse, run

FLOOR_BEHIND_TALL_BLOCK = "-1.2,0,-1.7"
WALL_BEHIND_TALL_BLOCK = "-1.1,0.8,-2.796"
FLOOR_CLOSE_TO_IT = "-0.9,0,1"
FLOOR_IN_FRONT_OF_IT = "-1.3,0,1.2"
FLOOR_AT_THE_BACK = "1.9,0,-2.2"
CEILING_AT_THE_BACK = "1.9,5.488,-2.2"
OPEN_FLOOR = "1.6,0,-1.3"
CEILING_ABOVE_IT = "1.6,5.488,-1.3"
LAMP = "0,5.478,0"


def answers(room_map, *arguments, **options):
    return run("query", room_map, *arguments, **options).splitlines()


def json_answers(room_map, *arguments):
    return json.loads(run("query", room_map, *arguments, "--json"))


def test_points_see_each_other_unless_something_stands_between(room_map):
    told = answers(room_map, "--sees", FLOOR_AT_THE_BACK, CEILING_AT_THE_BACK,
                   "--sees", FLOOR_IN_FRONT_OF_IT, FLOOR_BEHIND_TALL_BLOCK,
                   "--sees", FLOOR_BEHIND_TALL_BLOCK, LAMP,
                   "--sees", FLOOR_AT_THE_BACK, FLOOR_IN_FRONT_OF_IT)
    assert told == ["visible", "invisible", "invisible", "invisible"]


def test_a_point_is_named_by_its_index_too(room_map):
    [answer] = json_answers(room_map, "--sees", FLOOR_AT_THE_BACK, CEILING_AT_THE_BACK)
    floor, ceiling = answer["points"]
    [by_index] = json_answers(room_map, "--sees", floor, ceiling)
    assert by_index == {"question": f"sees {floor} {ceiling}", "answer": "visible", "points": [floor, ceiling]}


def test_groups_cost_far_less_than_their_pairs(room_map):
    seen, hidden = json_answers(room_map, "--groups", OPEN_FLOOR + ":0.3", CEILING_ABOVE_IT + ":0.3",
                                "--groups", WALL_BEHIND_TALL_BLOCK + ":0.2", FLOOR_CLOSE_TO_IT + ":0.2")
    assert seen["answer"] == "visible"
    assert seen["pairs"] == seen["points"][0] * seen["points"][1] > 50
    assert seen["primitive_tests"] < seen["pairs"] / 5
    assert hidden["answer"] == "invisible"


def test_the_first_object_along_a_ray(room_map):
    down, out, up = json_answers(room_map, "--ray", "1.9,2,-2.2", "0,-1,0", "--ray", "1.9,2,-2.2", "0,0,3",
                                 "--ray", "1.9,2,-2.2", "0,7,0")
    assert down["answer"] == up["answer"] == "hit"
    assert down["distance"] == pytest.approx(2, abs=1e-4)
    assert up["distance"] == pytest.approx(3.488, abs=1e-4)
    assert out == {"question": "ray 1.9,2,-2.2 0,0,3", "answer": "miss"}
    [nearest] = json_answers(room_map, "--sees", FLOOR_AT_THE_BACK, FLOOR_AT_THE_BACK)
    assert nearest["answer"] == "invisible", "no point sees itself"


def test_the_umbra_of_the_lamp(room_map):
    assert answers(room_map, "--umbra", FLOOR_BEHIND_TALL_BLOCK) == ["surface0=umbra"]
    [lit] = json_answers(room_map, "--umbra", FLOOR_AT_THE_BACK)
    assert lit["lights"] == [{"light": "surface0", "answer": "lit"}]


def test_rays_of_a_file_are_answered_one_per_line(room_map, tmp_path):
    rays = tmp_path / "rays.txt"
    rays.write_text("# down, out\n1.9 2 -2.2 0 -1 0\n\n1.9,2,-2.2 0,0,1\n")
    down, out = answers(room_map, "--rays", rays)
    point, distance = down.split()
    assert int(point) >= 0 and float(distance) == pytest.approx(2, abs=1e-4)
    assert out == "miss"


QUESTIONS = f"""# one of each kind
sees {FLOOR_AT_THE_BACK} {CEILING_AT_THE_BACK}
groups {FLOOR_AT_THE_BACK}:0.2 {FLOOR_IN_FRONT_OF_IT}:0.2

ray 1.9,2,-2.2 0,0,1
umbra {FLOOR_BEHIND_TALL_BLOCK}
"""


def test_questions_of_a_file_and_of_standard_input_are_answered_in_order(room_map, tmp_path):
    file = tmp_path / "questions.txt"
    file.write_text(QUESTIONS)
    told = answers(room_map, "--file", file)
    assert told[0] == "visible" and told[1].startswith("invisible ") and told[2:] == ["miss", "surface0=umbra"]
    assert answers(room_map, "--file", "-", stdin=QUESTIONS) == told
    as_json = json_answers(room_map, "--file", file)
    assert [answer["question"].split()[0] for answer in as_json] == ["sees", "groups", "ray", "umbra"]


@pytest.mark.parametrize("question", [
    ["--sees", "0", "4000000000"], ["--sees", "0", "99999999999"], ["--sees", "0", "-1"], ["--sees", "0", "1,2"],
    ["--sees", "0", "1,2,nan"], ["--sees", "0:1", "1"], ["--groups", "0:-1", "1:1"], ["--groups", "0:x", "1:1"],
    ["--groups", "9,9,9:0.1", "1:1"], ["--ray", "0,0,0", "0,0,0"], ["--ray", "0,0", "0,0,1"], ["--umbra", "one"], []])
def test_questions_that_make_no_sense_are_refused(room_map, question):
    refuse(2, "query", room_map, *question)


def test_a_bad_line_of_a_file_is_named(room_map, tmp_path):
    file = tmp_path / "questions.txt"
    file.write_text("sees 0 1\nsmells 0 1\n")
    assert "questions.txt:2:" in refuse(4, "query", room_map, "--file", file)
    assert "questions.txt:1:" in refuse(4, "query", room_map, "--rays", file)
    assert "absent.txt" in refuse(4, "query", room_map, "--file", tmp_path / "absent.txt")


def test_what_is_no_map_is_refused(tmp_path):
    file = tmp_path / "room.vmap"
    file.write_text("no map")
    assert "room.vmap" in refuse(4, "query", file, "--sees", 0, 1)
    assert "absent.vmap" in refuse(4, "query", tmp_path / "absent.vmap", "--sees", 0, 1)
