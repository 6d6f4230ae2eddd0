"""Python beside the page of exercise 1.1."""

_PLANTS = {
    "a greenhouse": {
        "r": "the 22 °C that tomatoes like",
        "e": "how much colder than 22 °C the air is",
        "u": "the requested opening of the heating valve",
        "d": "the sunshine on the glass",
        "y": "the temperature of the air",
        "n": "the jitter in the reading of the thermometer",
    },
    "a car with cruise control": {
        "r": "the 90 km/h that the driver has keyed in",
        "e": "how much slower than 90 km/h the car is",
        "u": "the requested position of the throttle",
        "d": "the slope of the road",
        "y": "the speed of the car",
        "n": "the jitter in the reading of the speedometer",
    },
    "a water tower": {
        "r": "the 6 m at which the water should stand",
        "e": "how far the water is below the 6 m",
        "u": "the requested speed of the pump in the well",
        "d": "the water that the town draws from the tower",
        "y": "the height of the water in the tower",
        "n": "the waves under the level sensor, as its signal shows them",
    },
    "a ferry on its course": {
        "r": "the heading that the captain has ordered",
        "e": "by how much the ferry must turn to reach the ordered heading",
        "u": "the requested angle of the rudder",
        "d": "the wind from the side",
        "y": "the heading of the ferry",
        "n": "the trembling of the compass",
    },
    "an incubator for eggs": {
        "r": "the 37.7 °C that a hen would give",
        "e": "how much colder than 37.7 °C the air is",
        "u": "the share of the time for which the heating coil is switched on",
        "d": "the cold air that comes in when somebody opens the door",
        "y": "the temperature of the air around the eggs",
        "n": "the random last digit of the measured temperature",
    },
}


def things(plant, roles):
    """The quantities of a plant that play these roles."""
    return [_PLANTS[plant][role] for role in roles]
