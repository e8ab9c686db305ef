#!/usr/bin/env python3
"""peers.py CLIP OUT: what OpenCV makes of the mask of a clip's first frame, without learning.

CLIP has `frames` and `masks`; the mask of every frame, 0 and 1, is written to OUT/NAME/NNNNN.png, NAME being that of the clip. From frame
to frame the mask is carried along dense flow (DIS), and GrabCut decides within a band around its border. OUT/NAME/box/00000.png is what
GrabCut makes of the smallest box around the mask.
Needs numpy and opencv-python-headless. Deterministic."""
import os
import sys

import cv2
import numpy as np

BAND = 0.01  # half width of the band, of the diagonal
MARGIN = 4  # of what GrabCut sees around the band, in half widths
ROUNDS = 2  # of GrabCut
BOX_ROUNDS = 5  # from a box


def carried(mask, flow):
    """The mask of the frame before, where the flow to it comes from."""
    height, width = mask.shape
    x, y = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
    return (cv2.remap(mask.astype(np.float32), x + flow[..., 0], y + flow[..., 1], cv2.INTER_LINEAR) >= 0.5).astype(np.uint8)


def refined(frame, mask):
    """The mask with the border that GrabCut finds."""
    half = max(2, round(BAND * np.hypot(*mask.shape)))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * half + 1, 2 * half + 1))
    outer, inner = cv2.dilate(mask, disc), cv2.erode(mask, disc)
    seen = cv2.dilate(outer, np.ones((2 * MARGIN * half + 1,) * 2))
    states = np.where(mask > 0, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    states[inner > 0], states[outer == 0] = cv2.GC_FGD, cv2.GC_BGD
    x, y, width, height = cv2.boundingRect(seen)
    part = np.s_[y : y + height, x : x + width]
    cut = states[part].copy()
    if not (cut & 1).any() or (cut & 1).all():
        return mask
    cv2.setRNGSeed(1)
    cv2.grabCut(frame[part], cut, None, np.zeros((1, 65)), np.zeros((1, 65)), ROUNDS, cv2.GC_INIT_WITH_MASK)
    result = np.zeros_like(mask)
    result[part] = cut & 1
    return result


def boxed(frame, mask):
    """The object in the box around a mask."""
    result = np.zeros_like(mask)
    cv2.setRNGSeed(1)
    cv2.grabCut(frame, result, cv2.boundingRect(mask), np.zeros((1, 65)), np.zeros((1, 65)), BOX_ROUNDS, cv2.GC_INIT_WITH_RECT)
    return result & 1


def main(clip, out):
    cv2.setNumThreads(1)
    read = lambda folder: [cv2.imread(os.path.join(clip, folder, name)) for name in sorted(os.listdir(os.path.join(clip, folder)))]
    frames = read("frames")
    mask = read("masks")[0].any(axis=2).astype(np.uint8)
    dis = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    grey = [cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY) for frame in frames]
    target = os.path.join(out, os.path.basename(os.path.abspath(clip)))
    os.makedirs(os.path.join(target, "box"), exist_ok=True)
    cv2.imwrite(os.path.join(target, "box", "00000.png"), boxed(frames[0], mask))
    for t, frame in enumerate(frames):
        if t > 0:
            mask = refined(frame, carried(mask, dis.calc(grey[t], grey[t - 1], None)))
        cv2.imwrite(os.path.join(target, f"{t:05d}.png"), mask)


if __name__ == "__main__":
    main(*sys.argv[1:])
