export { CONTENT_SECURITY_POLICY as default } from '../../scripts/lib/policy.mjs';
