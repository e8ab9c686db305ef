#!/usr/bin/env python3
"""peers.py CLIP OUT: what OpenCV gives without learning, as labels that persist through time.

CLIP has the frames in `frames`; labels are written to OUT/METHOD/NAME/NNNNN.png, NAME being that of the clip, 0 the background:
  flow       DIS optical flow to the next frame, one affine motion by RANSAC, Otsu's threshold of the distance from it
  mog2, knn  the background subtractors of these names
Connected regions are objects. A region keeps its number if it overlaps, carried along the flow, a region of the next frame.
Needs numpy and opencv-python-headless. Deterministic."""
import os
import sys

import cv2
import numpy as np

SMALLEST = 0.002  # share of the frame of a region
LINKED = 0.1  # IoU of a region with its successor
FLOOR = 0.5  # pixels by which the flow of an object differs from that of the background


def flow_masks(flows):
    """Pixels whose flow differs from the affine motion of most."""
    for flow in flows:
        height, width = flow.shape[:2]
        places = np.stack(np.meshgrid(np.arange(4, width, 8), np.arange(4, height, 8)), -1).reshape(-1, 2)
        there = places + flow[places[:, 1], places[:, 0]]
        cv2.setRNGSeed(1)
        affine, _ = cv2.estimateAffine2D(places.astype(np.float32), there.astype(np.float32), ransacReprojThreshold=1.0)
        if affine is None:
            yield np.zeros((height, width), np.uint8)
            continue
        grid = np.stack([*np.meshgrid(np.arange(width), np.arange(height)), np.ones((height, width))], -1)
        distance = np.linalg.norm(grid @ affine.T - grid[..., :2] - flow, axis=2)
        scaled = np.clip(distance * 16, 0, 255).astype(np.uint8)
        threshold, _ = cv2.threshold(scaled, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
        yield (scaled > max(threshold, FLOOR * 16)).astype(np.uint8)


def subtracted(subtractor, frames):
    """Pixels that a background subtractor calls foreground, shadows left out."""
    for frame in frames:
        yield (subtractor.apply(frame) == 255).astype(np.uint8)


def regions(mask):
    """The connected regions of a mask that are large enough, as masks."""
    mask = cv2.medianBlur(cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)), 5)
    count, labels, figures, _ = cv2.connectedComponentsWithStats(mask)
    return [labels == k for k in range(1, count) if figures[k, cv2.CC_STAT_AREA] >= SMALLEST * mask.size]


def linked(masks, flows):
    """Label images in which a region keeps its number as long as it is found again."""
    carried, following = {}, 1
    for t, mask in enumerate(masks):
        found = regions(mask)
        pairs = [((old & new).sum() / max((old | new).sum(), 1), number, k) for number, old in carried.items() for k, new in enumerate(found)]
        numbers = {}
        for overlap, number, k in sorted(pairs, key=lambda pair: -pair[0]):
            if overlap >= LINKED and k not in numbers and number not in numbers.values():
                numbers[k] = number
        labels = np.zeros(mask.shape, np.uint8)
        carried = {}
        for k, region in enumerate(found):
            if k not in numbers:
                numbers[k], following = following, min(following + 1, 254)
            labels[region] = numbers[k]
            carried[numbers[k]] = moved(region, flows[t]) if t < len(flows) else region
        yield labels


def moved(region, flow):
    y, x = np.nonzero(region)
    u, v = np.rint(x + flow[y, x, 0]).astype(int), np.rint(y + flow[y, x, 1]).astype(int)
    inside = (u >= 0) & (v >= 0) & (u < region.shape[1]) & (v < region.shape[0])
    there = np.zeros_like(region)
    there[v[inside], u[inside]] = True
    return there


def main(clip, out):
    cv2.setNumThreads(1)
    folder = os.path.join(clip, "frames")
    frames = [cv2.imread(os.path.join(folder, name)) for name in sorted(os.listdir(folder))]
    dis = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    grey = [cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY) for frame in frames]
    flows = [dis.calc(first, second, None) for first, second in zip(grey, grey[1:])]
    # The last frame has a neighbour on the other side only.
    flows.append(dis.calc(grey[-1], grey[-2], None))
    methods = {
        "flow": flow_masks(flows),
        "mog2": subtracted(cv2.createBackgroundSubtractorMOG2(), frames),
        "knn": subtracted(cv2.createBackgroundSubtractorKNN(), frames),
    }
    for method, masks in methods.items():
        target = os.path.join(out, method, os.path.basename(os.path.abspath(clip)))
        os.makedirs(target, exist_ok=True)
        for t, labels in enumerate(linked(masks, flows)):
            cv2.imwrite(os.path.join(target, f"{t:05d}.png"), labels)


if __name__ == "__main__":
    main(*sys.argv[1:])
