// The entry `veronese/formats`: masks in the forms that annotation tools read and write. Pure functions; nothing is loaded.

export { encodeCoco, encodeCocoImages } from './coco.js';
export { encodeCocoRle, encodeCocoRleCounts } from './coco-rle.js';
export { encodeCocoVideo } from './coco-video.js';
export { encodeCvatMots } from './cvat-mots.js';
export { encodeCvatPoints } from './cvat-points.js';
export { encodeCvatVideo } from './cvat-video.js';
export { encodeCvatImages, encodeCvatXml } from './cvat-xml.js';
export { encodeDavis } from './davis.js';
export { encodeFlow } from './flow.js';
export { encodeLabelMe } from './labelme.js';
export { encodeLabelStudio } from './label-studio.js';
export { encodeLabelStudioVideo } from './label-studio-video.js';
export { encodeMotChallenge } from './mot-challenge.js';
export { encodeMots } from './mots.js';
export { readAnnotations } from './reading/annotations.js';
export { encodeSupervisely } from './supervisely.js';
export { decodeVeronese, encodeVeronese } from './veronese-json.js';
export { encodeWebAnnotation } from './web-annotation.js';
export { encodeYolo } from './yolo.js';
