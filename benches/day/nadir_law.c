/* The law of nadir.toml as SandboxFSW of 42, which 42 offers for laws of one's own: three wheels along x, y and z point the body
   to the Earth as a sphere, and magnetorquers along them unload the wheels. */
void SandboxFSW(struct SCType *S)
{
   const double bandwidth = 0.05, damping = 0.8, unload = 2.0E-3, inertia = 0.5667;
   struct AcType *AC = &S->AC;
   double CLN[3][3], CBN[3][3], q[4], wn[3], w[3], h[3], all[3], turn[3], mxb[3], m[3], square = 0.0;
   long i;

   FindCLN(AC->PosN, AC->VelN, CLN, wn);
   Q2C(AC->qbn, CBN);
   MxV(CBN, wn, w);
   C2Q(CLN, AC->qrn);
   QxQT(AC->qbn, AC->qrn, q);
   RECTIFYQ(q);
   for (i = 0; i < 3; i++) {
      h[i] = AC->Whl[i].H;
      all[i] = inertia*AC->wbn[i] + h[i];
      square += AC->bvb[i]*AC->bvb[i];
   }
   VxV(AC->wbn, all, turn);
   for (i = 0; i < 3; i++) {
      AC->Tcmd[i] = turn[i] - inertia*(2.0*damping*bandwidth*(AC->wbn[i] - w[i])
         + bandwidth*bandwidth*4.0*q[i]/(1.0 + q[3]));
   }
   VxV(h, AC->bvb, m);
   for (i = 0; i < 3; i++) {
      m[i] *= unload/square;
      AC->MTB[i].Mcmd = m[i];
   }
   VxV(m, AC->bvb, mxb);
   for (i = 0; i < 3; i++) AC->Whl[i].Tcmd = mxb[i] - AC->Tcmd[i];
}
