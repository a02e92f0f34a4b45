#!/usr/bin/env python3
"""An OSM file of L-shaped houses in terraces of five, for measuring time and memory on large inputs: osm_town.py NUMBER > town.osm"""
import random
import sys

count = int(sys.argv[1])
random.seed(1)
columns, terrace = 500, 5
step_x, step_y = 4e-4, 3e-4   # degrees: some 30 m
out = sys.stdout
out.write('<?xml version="1.0"?>\n<osm version="0.6">\n')


def corners(house):
    x, y = 11 + step_x * (house % columns), 48 + step_y * (house // columns)
    touches_next = house % columns % terrace != terrace - 1
    width, depth = (step_x if touches_next else random.uniform(1.2e-4, 2.2e-4)), random.uniform(0.9e-4, 1.5e-4)
    return [(x, y), (x + width, y), (x + width, y + 0.6 * depth), (x + 0.6 * width, y + 0.6 * depth), (x + 0.6 * width, y + depth), (x, y + depth)]


def tags(house):
    yield 'building', 'yes'
    yield 'addr:housenumber', house % 97
    if house % 3 == 0:
        yield 'height', '%.1f' % random.uniform(4, 30)
    if house % 3 == 1:
        yield 'building:levels', house % 8 + 1
    if house % 7 == 0:
        yield 'roof:shape', 'gabled'


for house in range(count):
    for i, (lon, lat) in enumerate(corners(house)):
        out.write('<node id="%d" version="1" lat="%.7f" lon="%.7f"/>\n' % (6 * house + i + 1, lat, lon))
for house in range(count):
    nodes = [6 * house + i + 1 for i in range(6)]
    out.write('<way id="%d" version="1">' % (house + 1))
    out.write(''.join('<nd ref="%d"/>' % n for n in nodes + nodes[:1]))
    out.write(''.join('<tag k="%s" v="%s"/>' % tag for tag in tags(house)) + '</way>\n')
out.write('</osm>\n')
