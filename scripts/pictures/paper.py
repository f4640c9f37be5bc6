"""What the paper says of its seven examples: the values a run must have to stand in its figures."""

from dataclasses import dataclass

from studies.study import InputError


@dataclass(frozen=True)
class Example:
    elasticity: float  # E
    gravity: float  # g, cm/s^2
    height: float  # of the centre at the start, cm
    speed: float  # to the right at the start, cm/s
    contact: tuple  # alpha, beta of every wall
    walls: int
    times: tuple  # of the pictures, s


EVERY_3 = (0.0, 3.0, 6.0, 9.0, 12.0, 15.0)
EVERY_2 = (0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0)
FIFTEEN = (0.0, 1.5, 3.0, 4.5, 6.0, 7.5, 8.5, 9.0, 10.5, 12.0, 13.5, 15.0, 16.5, 18.0, 19.5)

EXAMPLES = {
    1: Example(1000.0, 0.098, 10.0, 0.0, (0.0, 0.0), 1, EVERY_3),
    2: Example(16000.0, 0.098, 10.0, 0.0, (0.0, 0.0), 1, EVERY_3),
    3: Example(1000.0, 0.98, 15.0, 0.0, (0.0, 0.0), 1, (0.0, 3.0, 6.0)),
    4: Example(16000.0, 0.98, 15.0, 0.0, (0.0, 0.0), 1, FIFTEEN),
    5: Example(16000.0, 0.098, 10.0, 4.0, (0.0, 0.0), 1, EVERY_2),
    6: Example(16000.0, 0.098, 10.0, 4.0, (1.0, -1.0), 1, EVERY_2),
    7: Example(16000.0, 0.098, 10.0, 0.0, (1.0, -1.0), 2, (0.0, 8.0, 14.0, 20.0)),
}


def check_is_example(run, number):
    """InputError unless the run's scene is this example of the paper and has its pictures' times."""
    paper, scene = EXAMPLES[number], run.scene
    wall_rules = {(wall["alpha"], wall["beta"]) for wall in scene["wall"]}
    wanted = {
        "ball.radii": (scene["ball"]["radii"], [5.0, 6.0, 7.0]),
        "ball.per_ring": (scene["ball"]["per_ring"], 120),
        "ball.centre[1]": (scene["ball"]["centre"][1], paper.height),
        "ball.velocity": (scene["ball"]["velocity"], [paper.speed, 0.0]),
        "law.p, law.q": ((scene["law"]["p"], scene["law"]["q"]), (3.0, 5.0)),
        "law.elasticity": (scene["law"]["elasticity"], paper.elasticity),
        "gravity.acceleration": (scene["gravity"]["acceleration"], [0.0, -paper.gravity]),
        "number of walls": (len(scene["wall"]), paper.walls),
        "alpha and beta of the walls": (wall_rules, {paper.contact}),
    }
    for key, (found, asked) in wanted.items():
        if found != asked:
            raise InputError(
                f"{run.path / 'scene.toml'}: {key} is {found}, Example {number} has {asked}"
            )
    for time in paper.times:
        run.at(time)
